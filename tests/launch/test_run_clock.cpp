#include "launch/observatory/run_clock.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/runtime/network_threads.h"
#include "tests/runtime/toy.h"

namespace dmise {
namespace {

using namespace test;
using testing::HasSubstr;

constexpr double patience_s = 20.0;

/// A run of two nodes with ticks of 1 s.
struct PacedRun {
  explicit PacedRun(double pace, Tick last_tick = 40)
      : master(options(pace, last_tick)), broker(start_broker(master.address)) {}
  static MasterOptions options(double pace, Tick last_tick) {
    auto options = run_of({"orbit", "a"}, last_tick);
    options.run.pace.factor = pace;
    return options;
  }
  void begin() {
    nodes.push_back(start(orbit, master.address));
    nodes.push_back(start(camera, master.address));
  }
  RunStatus status() const { return ask_master(master.address, patience_s); }

  ToyOrbit orbit;
  ToyCamera camera{"a"};
  MasterThread master;
  std::future<BrokerResult> broker;
  std::vector<std::future<NodeResult>> nodes;
};

/// Waits as an observatory does; false if the time never comes.
bool comes(const RunClock& clock, SimTime t) {
  const auto deadline =
      std::chrono::steady_clock::now() + std::chrono::duration<double>(patience_s);
  std::mutex mutex;
  std::condition_variable changed;
  std::unique_lock lock(mutex);
  while (clock.now() < t && std::chrono::steady_clock::now() < deadline)
    clock.wait_until(t, lock, changed);
  return clock.now() >= t;
}

TEST(PacedOffset, IsMovedAsLittleAsTheTicksAsk) {
  // Tick 3 of 5 s may be done, at twice real time: it is between 15 and 20 s.
  EXPECT_EQ(paced_offset_s(0.0, 2.0, 8.0, 15.0, 5.0), 0.0);
  EXPECT_EQ(paced_offset_s(0.0, 2.0, 7.0, 15.0, 5.0), 1.0);
  EXPECT_EQ(paced_offset_s(0.0, 2.0, 11.0, 15.0, 5.0), -2.0);
}

TEST(RunClock, IsBetweenTheTickOfTheRunAndTheNext) {
  PacedRun run(20.0);
  const RunClock clock(run.master.address, {});
  EXPECT_EQ(clock.now(), SimTime{0});  // nobody has joined
  run.begin();
  SimTime before{0};
  for (Tick tick = 1; tick <= 30; ++tick) {
    ASSERT_TRUE(comes(clock, sim_seconds(double(tick) - 0.5)));
    const SimTime now = clock.now();
    EXPECT_GE(now, before);
    EXPECT_LE(now, sim_seconds(double(run.status().granted + 1)));
    before = now;
  }
  EXPECT_TRUE(comes(clock, sim_seconds(40.0)));
  run.master.result.wait();
  const auto deadline =
      std::chrono::steady_clock::now() + std::chrono::duration<double>(patience_s);
  while (clock.ended().empty() && std::chrono::steady_clock::now() < deadline)
    std::this_thread::yield();
  EXPECT_FALSE(clock.ended().empty());
  EXPECT_LE(clock.now(), sim_seconds(41.0));
}

TEST(RunClock, WaitsWhereTheRunIsPaused) {
  PacedRun run(20.0);
  control_master(run.master.address, patience_s, {ClockAction::pause, 10});
  run.begin();
  const RunClock clock(run.master.address, {});
  ASSERT_TRUE(comes(clock, sim_seconds(10.5)));
  std::mutex mutex;
  std::condition_variable changed;
  std::unique_lock lock(mutex);
  for (int i = 0; i < 10; ++i) clock.wait_until(sim_seconds(30.0), lock, changed);
  EXPECT_LE(clock.now(), sim_seconds(11.0));
  control_master(run.master.address, patience_s, {ClockAction::go_on});
  EXPECT_TRUE(comes(clock, sim_seconds(20.0)));
}

TEST(RunClock, RefusesAnEmptyAddress) { EXPECT_THROW(RunClock("", {}), ConfigError); }

TEST(RunClock, RefusesARunWithoutAPace) {
  PacedRun run(0.0);
  try {
    const RunClock clock(run.master.address, {});
    ADD_FAILURE() << "it has a clock";
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("as fast as it can"));
  }
  run.begin();
  run.master.result.wait();
}

}  // namespace
}  // namespace dmise
