#include "nodes/fusion/recorded_tracker.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <vector>

#include "core/base/error.h"
#include "core/config/node_kinds.h"
#include "tests/own/sample_recording.h"

namespace dmise {
namespace {

using testing::EndsWith;
using testing::ThrowsMessage;

constexpr std::uint16_t tracks = 2, tasks = 3;  // channels

class RecordedTrackerTest : public testing::Test {
 public:
  ~RecordedTrackerTest() override { std::filesystem::remove(path_); }

 protected:
  /// The tracker of a recording with these records, of a run with a sensor that is cued.
  RecordedTracker tracker(const std::string& records) const {
    std::ofstream(path_, std::ios::binary)
        << test::mcap_magic << test::run_records()
        << test::channel_record(tracks, "track/fusion-node", "dmise.v1.RecordedMessage")
        << test::channel_record(tasks, "task/scope", "dmise.v1.RecordedMessage") << records;
    Scenario scenario = test::sample_scenario();
    scenario.sensors.push_back({.name = "scope", .pointing = PointCued{}});
    return {scenario, test::sample_digest, path_};
  }
  /// What is said of a tick: as many live tracks as its number.
  static std::string tick_records(Tick tick, bool tasked) {
    const SimTime time = test::sample_scenario().time_of(tick);
    const TrackSet set{
        .tick = tick, .time = time, .node = fusion_node, .live = std::uint32_t(tick)};
    TaskSet given{.tick = tick, .time = time, .node = fusion_node, .sensor = "scope"};
    if (tasked)
      given.tasks.push_back({.id = 7,
                             .sensor = "scope",
                             .track = 1,
                             .given = time,
                             .start = time,
                             .on_target = time,
                             .end = {time.ns + 1},
                             .first_frame = 1,
                             .exposures = 1,
                             .path_start = time,
                             .path_step_s = 1.0,
                             .path_m = std::vector<double>(6, 7e6),
                             .path_m_per_s = std::vector<double>(6)});
    return test::message_record(tracks, test::recorded(set, test::envelope_of_last(tick))) +
           test::message_record(tasks, test::recorded(given, test::envelope_of_last(tick)));
  }

  const std::string path_ = (std::filesystem::path(testing::TempDir()) / "dmise-tracks").string();
};

TEST_F(RecordedTrackerTest, SaysTheTracksAndTasksOfEachTick) {
  // A node that was started again has said tick 1 twice.
  RecordedTracker tracker = this->tracker(tick_records(0, false) + tick_records(1, true) +
                                          tick_records(1, true) + tick_records(2, false));
  for (Tick tick = 0; tick <= test::sample_last_tick; ++tick) {
    const auto said = tracker.step(tick, {});
    EXPECT_EQ(said->tracks.live, std::size_t(tick));
    std::vector<std::uint32_t> ids;
    for (const Task& task : *said->tasks) ids.push_back(task.id);
    EXPECT_EQ(ids, tick == 1 ? std::vector{7u} : std::vector<std::uint32_t>());
  }
}

TEST_F(RecordedTrackerTest, RefusesARecordingThatIsNotWhole) {
  EXPECT_THAT([&] { tracker(tick_records(0, false) + tick_records(1, true)); },
              ThrowsMessage<ConfigError>(EndsWith(" up to tick 1, the run has 2")));
  EXPECT_THAT([&] { tracker(tick_records(0, false) + tick_records(2, false)); },
              ThrowsMessage<ConfigError>(EndsWith(": lacks tracks of tick 1")));
  EXPECT_THAT([&] { tracker(""); },
              ThrowsMessage<ConfigError>(EndsWith(" up to tick -1, the run has 2")));
  EXPECT_THAT([&] { tracker(test::message_record(tracks, test::recorded(test::states_at(0)))); },
              ThrowsMessage<ConfigError>(
                  EndsWith(": has something else than tracks and tasks of the fusion node")));
}

}  // namespace
}  // namespace dmise
