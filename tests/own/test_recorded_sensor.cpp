#include "nodes/own/recorded_sensor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "core/base/error.h"
#include "tests/own/sample_recording.h"

namespace dmise {
namespace {

using testing::EndsWith;
using testing::ThrowsMessage;

class RecordedSensorTest : public testing::Test {
 public:
  ~RecordedSensorTest() override { std::filesystem::remove(path_); }

 protected:
  /// Writes a recording of sensor "eye" that has detections of these frames, as many as their
  /// number in each, and reports of those.
  void record(const std::vector<std::uint32_t>& detected,
              const std::vector<std::uint32_t>& reported) const {
    std::string records = test::run_records();
    std::uint16_t channel = 2;
    for (const char* topic : {"detection/eye", "detection/other", "frame/eye"})
      records += test::channel_record(channel++, topic, "dmise.v1.RecordedMessage");
    for (const std::uint32_t frame : detected)
      records += test::message_record(3, test::recorded(DetectionSet{"other", 9, {}})) +
                 test::message_record(2, test::recorded(found(frame)));
    for (const std::uint32_t frame : reported)
      records += test::message_record(4, test::recorded(report(frame)));
    std::ofstream(path_, std::ios::binary) << test::mcap_magic << records;
  }
  SourceFinder finder(const std::vector<std::uint32_t>& recorded, std::uint32_t needed) const {
    record(recorded, {});
    return recorded_finder({scenario_, sensor_, needed, digest_, path_});
  }
  ExposureObserver observer(const std::vector<std::uint32_t>& detected,
                            const std::vector<std::uint32_t>& reported,
                            std::uint32_t needed) const {
    record(detected, reported);
    return recorded_observer({scenario_, sensor_, needed, digest_, path_});
  }
  static FrameReport report(std::uint32_t frame) {
    return {.sensor = "eye", .frame = frame, .limiting_magnitude = 0.1 * frame};
  }
  static DetectionSet found(std::uint32_t frame) {
    DetectionSet set{"eye", frame, {}};
    for (std::uint32_t index = 0; index < frame; ++index)
      set.detections.push_back({.id = "eye/" + std::to_string(frame) + "/" + std::to_string(index),
                                .sensor = "eye",
                                .frame = frame,
                                .index = index});
    return set;
  }

  const Scenario scenario_ = test::sample_scenario();
  const std::string sensor_ = "eye", digest_ = test::sample_digest;
  const std::string path_ =
      (std::filesystem::path(testing::TempDir()) / "dmise-detections").string();
};

TEST_F(RecordedSensorTest, FindsInEachFrameWhatWasFoundInIt) {
  const SourceFinder find = finder({1, 2, 2, 3}, 3);
  for (const std::uint32_t frame : {3u, 1u, 2u}) {
    const auto got = find(CountImage{}, FrameHeader{.frame = frame});
    EXPECT_EQ(std::get<std::vector<Detection>>(*got), found(frame).detections);
  }
}

TEST_F(RecordedSensorTest, RefusesARecordingWithoutAFrame) {
  EXPECT_THAT(
      [&] {
        finder({1, 3}, 3);
      },
      ThrowsMessage<ConfigError>(EndsWith(": lacks frame 2 of sensor eye")));
  EXPECT_THAT([&] { finder({}, 1); },
              ThrowsMessage<ConfigError>(EndsWith(": lacks frame 1 of sensor eye")));
}

// Nobody knows which frames there will be of a sensor that is cued.
TEST_F(RecordedSensorTest, EndsTheRunAtAFrameThatItLacks) {
  const SourceFinder find = finder({1}, 0);
  EXPECT_TRUE(find(CountImage{}, FrameHeader{.frame = 1}));
  EXPECT_THAT([&] { find(CountImage{}, FrameHeader{.frame = 2}); },
              ThrowsMessage<Error>(EndsWith(": lacks frame 2 of sensor eye")));
}

TEST_F(RecordedSensorTest, ObservesWhatWasObserved) {
  const ExposureObserver observe = observer({1, 2}, {2, 1}, 2);
  for (const std::uint32_t frame : {2u, 1u}) {
    const auto got = std::get<ObservedBefore>(*observe({.frame = frame}));
    EXPECT_EQ(got.report.limiting_magnitude, report(frame).limiting_magnitude);
    EXPECT_EQ(got.detections, found(frame).detections);
  }
}

TEST_F(RecordedSensorTest, RefusesARecordingWithoutAReportOrItsDetections) {
  EXPECT_THAT(
      [&] {
        observer({1, 2}, {1}, 2);
      },
      ThrowsMessage<ConfigError>(EndsWith(": lacks frame 2 of sensor eye")));
  EXPECT_THAT(
      [&] {
        observer({2}, {1, 2}, 2);
      },
      ThrowsMessage<ConfigError>(EndsWith(": lacks frame 1 of sensor eye")));
}

}  // namespace
}  // namespace dmise
