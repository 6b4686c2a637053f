// A gateway beside a real run, in one process: it sees the run, controls it, and is waited for by
// nobody.
#include "nodes/gateway/run_observer.h"

#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <thread>

#include "nodes/gateway/web_server.h"
#include "tests/runtime/network_threads.h"
#include "tests/runtime/toy.h"
#include "tests/runtime/until_lost.h"

namespace dmise {
namespace {

using Json = nlohmann::json;
using test::MasterThread;

/// Publishes where the Earth is, which positions need.
struct Environment : Actor {
  std::string name() const override { return "environment"; }
  std::vector<std::string> produces() const override { return {environment_topic}; }
  std::vector<Message> step(Tick tick, std::span<const Message>) override {
    EnvironmentState state{.tick = tick, .time = {tick * 1'000'000'000}};
    state.earth.time = state.time;
    state.sun_m = {1.5e11, 0, 0};
    state.moon_m = {3.8e8, 0, 0};
    state.tt_jd1 = 2458139.5;
    state.earth_barycentric_m = {1.5e11, 0, 0};
    return {{environment_topic, tick, std::make_shared<const State>(state)}};
  }
};

struct ObserverThread {
  explicit ObserverThread(const std::string& master, bool takes_truth = false)
      : observer({.master = master, .takes_truth = takes_truth, .stop = &stop}, latest, history),
        thread([this] { observer.run([] {}); }) {}
  ~ObserverThread() {
    stop.set();
    thread.join();
  }
  Json json_of(MessageSlot slot) const {
    const auto message = latest.of(slot);
    return message ? Json::parse(message->bytes) : Json();
  }
  /// Waits until a condition of the status holds.
  template <class Condition>
  bool until(Condition holds) const {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (std::chrono::steady_clock::now() < deadline) {
      if (const Json status = json_of(MessageSlot::status); !status.is_null() && holds(status))
        return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return false;
  }

  Event stop;
  LatestMessages latest;
  ViewHistory history;
  RunObserver observer;
  std::thread thread;
};

TEST(RunObserver, SeesARunItJoinsLateAndControlsItsClock) {
  MasterOptions options = test::run_of({"orbit", "environment", "a"}, 1'000'000);
  options.run.pace.factor = 20.0;
  const MasterThread master(options);
  auto broker = test::start_broker(master.address);
  test::ToyOrbit orbit(20);
  test::ToyCamera camera("a");
  Environment environment;
  Event stop;
  [[maybe_unused]] auto nodes = {test::start(orbit, master.address, &stop),
                                 test::start(camera, master.address, &stop),
                                 test::start(environment, master.address, &stop)};
  const auto settled = [&] { return ask_master(master.address, 30.0).settled; };
  test::wait_until_settled(master.address, 5);

  ObserverThread seen(master.address);
  // Everything comes: also the roster, which was published before.
  ASSERT_TRUE(seen.until([&](const Json&) {
    return seen.latest.of(MessageSlot::objects) && seen.latest.of(MessageSlot::roster) &&
           seen.latest.of(MessageSlot::detections);
  }));
  EXPECT_EQ(seen.json_of(MessageSlot::roster)["objects"].size(), 20u);
  std::uint32_t count = 0;
  std::memcpy(&count, seen.latest.of(MessageSlot::objects)->bytes.data() + 4, 4);
  EXPECT_EQ(count, 20u);

  // Truth comes to whoever takes it, from the sensor itself.
  EXPECT_FALSE(seen.latest.of(MessageSlot::truth));
  {
    const ObserverThread referee(master.address, true);
    EXPECT_TRUE(
        referee.until([&](const Json&) { return bool(referee.latest.of(MessageSlot::truth)); }));
  }
  EXPECT_FALSE(seen.latest.of(MessageSlot::truth));

  // The clock's list of who takes part and is waited for has no gateway in it.
  for (const auto& node : ask_master(master.address, 30.0).nodes) EXPECT_NE(node.name, "gateway");

  seen.observer.command({ClockCommand::Action::pause, 0});
  ASSERT_TRUE(seen.until(
      [](const Json& s) { return s["paused"] == true && s["settled_tick"] == s["granted_tick"]; }));
  const Tick paused_at = settled();
  seen.observer.command({ClockCommand::Action::step, 3});
  ASSERT_TRUE(seen.until([&](const Json& s) { return s["settled_tick"] == paused_at + 3; }));
  EXPECT_EQ(settled(), paused_at + 3);
  seen.observer.command({ClockCommand::Action::go_on, 0});
  EXPECT_TRUE(seen.until([&](const Json& s) { return s["settled_tick"] > paused_at + 3; }));
  seen.observer.command({.action = ClockCommand::Action::pace, .factor = 200.0});
  EXPECT_TRUE(seen.until([&](const Json& s) { return s["pace"] == 200.0; }));
  stop.set();
}

}  // namespace
}  // namespace dmise
