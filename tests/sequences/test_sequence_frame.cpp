#include "core/sequences/sequence_frame.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "tests/sequences/simulated_sequence.h"

namespace dmise {
namespace {

using simulated::SimulatedSequence;

std::vector<SequenceFrame> plain_frames() {
  const SimulatedSequence scene{.frames = 3};
  std::vector<SequenceFrame> frames;
  for (int i = 0; i < 3; ++i)
    frames.push_back({"f" + std::to_string(i), CountImage(8, 8, 100), scene.header(i)});
  return frames;
}

std::string refusal(const std::function<void(std::vector<SequenceFrame>&)>& change) {
  auto frames = plain_frames();
  change(frames);
  try {
    check_sequence(frames);
    sort_by_time(frames);
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "";
}

TEST(SequenceFrames, OfOneCameraAndExposureAreASequence) {
  EXPECT_EQ(refusal([](auto&) {}), "");
}

TEST(SequenceFrames, OneOrTwoFramesAreNone) {
  EXPECT_EQ(refusal([](auto& f) { f.resize(1); }), "--sequence: takes 3 to 200 frames, got 1");
  EXPECT_EQ(refusal([](auto& f) { f.resize(2); }), "--sequence: takes 3 to 200 frames, got 2");
}

TEST(SequenceFrames, OfDifferentSizesSensorsOrExposuresAreRefusedInOneLine) {
  EXPECT_EQ(refusal([](auto& f) { f[1].counts = CountImage(9, 8); }),
            "f1: frames of a sequence are of one size: 9 x 8 px, but f0 has 8 x 8 px");
  EXPECT_EQ(refusal([](auto& f) { f[2].header.sensor = "other"; }),
            "f2: frames of a sequence are of one sensor: \"other\", but f0 is of \"test\"");
  EXPECT_EQ(refusal([](auto& f) { f[2].header.exposure_s = 3.0; }),
            "f2: frames of a sequence are exposed equally: 3 s, but f0 2 s");
}

TEST(SequenceFrames, WithoutATimeOrOfTheSameTimeAreRefused) {
  EXPECT_EQ(refusal([](auto& f) { f[1].header.unknown.add(FrameFact::time); }),
            "f1: a frame of a sequence needs a time (DATE-OBS)");
  EXPECT_EQ(refusal([](auto& f) { f[1].header.unknown.add(FrameFact::exposure); }),
            "f1: a frame of a sequence needs an EXPTIME");
  EXPECT_EQ(refusal([](auto& f) { f[2].header.middle_utc = f[0].header.middle_utc; }),
            "f2: frames of a sequence have different times, but f0 is of the same");
}

TEST(SequenceFrames, AreSortedByTheirTimes) {
  auto frames = plain_frames();
  std::swap(frames[0], frames[2]);
  sort_by_time(frames);
  EXPECT_EQ(frames[0].name, "f0");
  EXPECT_DOUBLE_EQ(seconds_between(frames[0], frames[2]), 10.0);
}

}  // namespace
}  // namespace dmise
