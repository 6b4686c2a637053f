#include "nodes/own/recorded_detector.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "core/base/error.h"
#include "tests/own/sample_recording.h"

namespace dmise {
namespace {

using testing::EndsWith;
using testing::ThrowsMessage;

class RecordedDetectorTest : public testing::Test {
 public:
  ~RecordedDetectorTest() override { std::filesystem::remove(path_); }

 protected:
  /// The finder of a recording of sensor "eye" that has these frames, as many detections as their
  /// number in each.
  SourceFinder finder(const std::vector<std::uint32_t>& recorded, std::uint32_t needed) const {
    std::string records = test::run_records() +
                          test::channel_record(2, "detection/eye", "dmise.v1.RecordedMessage") +
                          test::channel_record(3, "detection/other", "dmise.v1.RecordedMessage");
    for (const std::uint32_t frame : recorded)
      records += test::message_record(3, test::recorded(DetectionSet{"other", 9, {}})) +
                 test::message_record(2, test::recorded(found(frame)));
    std::ofstream(path_, std::ios::binary) << test::mcap_magic << records;
    return recorded_finder(test::sample_scenario(), "eye", needed, test::sample_digest, path_);
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

  const std::string path_ =
      (std::filesystem::temp_directory_path() / ("dmise-detections-" + std::to_string(getpid())))
          .string();
};

TEST_F(RecordedDetectorTest, FindsInEachFrameWhatWasFoundInIt) {
  const SourceFinder find = finder({1, 2, 2, 3}, 3);
  for (const std::uint32_t frame : {3u, 1u, 2u}) {
    const auto got = find(CountImage{}, FrameHeader{.frame = frame});
    EXPECT_EQ(std::get<std::vector<Detection>>(*got), found(frame).detections);
  }
}

TEST_F(RecordedDetectorTest, RefusesARecordingWithoutAFrame) {
  EXPECT_THAT(
      [&] {
        finder({1, 3}, 3);
      },
      ThrowsMessage<ConfigError>(EndsWith(": lacks frame 2 of sensor eye")));
  EXPECT_THAT([&] { finder({}, 1); },
              ThrowsMessage<ConfigError>(EndsWith(": lacks frame 1 of sensor eye")));
}

// Of a sensor that is cued nobody knows which frames there will be.
TEST_F(RecordedDetectorTest, EndsTheRunAtAFrameThatItLacks) {
  const SourceFinder find = finder({1}, 0);
  EXPECT_TRUE(find(CountImage{}, FrameHeader{.frame = 1}));
  EXPECT_THAT([&] { find(CountImage{}, FrameHeader{.frame = 2}); },
              ThrowsMessage<Error>(EndsWith(": lacks frame 2 of sensor eye")));
}

}  // namespace
}  // namespace dmise
