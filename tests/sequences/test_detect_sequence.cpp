#include "core/sequences/detect_sequence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/detection/detect.h"
#include "core/sequences/sequence_lines.h"
#include "tests/sequences/simulated_sequence.h"

namespace dmise {
namespace {

using simulated::SimulatedFrame;
using simulated::SimulatedSequence;

SequenceResult found_in(std::vector<SequenceFrame> frames, bool stack = false, int count = 2) {
  Threads threads(count);
  SequenceSearch search;
  search.stack = stack;
  return detect_sequence(std::move(frames), search, threads);
}

/// An object at `place` in the middle frame that moves over the detector by `px` a frame.
auto object_at(PixelPosition place, PixelPosition px, double snr, int middle) {
  return [=](SimulatedFrame& frame, int i) {
    const PixelPosition at = place + px * (i - middle);
    frame.add_point(at.x_px, at.y_px, SimulatedSequence::flux_e(snr));
  };
}

bool is_at(const SequenceTrack& track, PixelPosition place, double px) {
  return std::hypot(track.detection.x_px - place.x_px, track.detection.y_px - place.y_px) < px;
}

TEST(DetectSequence, FindsWhatStaysOnTheDetectorWhileStarsDrift) {
  SimulatedSequence scene{.fixed = true};
  scene.add = object_at({120.3, 90.7}, {0.0, 0.0}, 12, scene.frames / 2);
  const auto found = found_in(scene.draw());
  ASSERT_EQ(found.tracks.size(), 1U);
  const SequenceTrack& track = found.tracks[0];
  EXPECT_TRUE(is_at(track, {120.3, 90.7}, 0.3)) << track.detection.x_px;
  // As fast as the stars go, to the east, for which they turn: 15.041 arcsec/s on the equator.
  const double rate = 15.041 * std::cos(track.detection.dec_rad);
  const double sigma = std::sqrt(track.covariance[5]) / arcsec;
  EXPECT_NEAR(track.rate_ra_rad_per_s / arcsec, rate, 4 * sigma);
  EXPECT_LT(sigma, 0.15);
  EXPECT_NEAR(track.rate_dec_rad_per_s / arcsec, 0.0, 4 * std::sqrt(track.covariance[9]) / arcsec);
  EXPECT_GE(track.positions.size(), 7U);
}

TEST(DetectSequence, FindsWhatMovesAmongStarsThatRest) {
  SimulatedSequence scene{.fixed = false};
  scene.add = object_at({130.0, 110.0}, {6.2, -2.4}, 12, scene.frames / 2);
  const auto found = found_in(scene.draw());
  ASSERT_EQ(found.tracks.size(), 1U);
  EXPECT_TRUE(is_at(found.tracks[0], {130.0, 110.0}, 0.3));
  EXPECT_NEAR(found.tracks[0].rate_px_per_s.x_px, 6.2 / 5, 0.02);
  EXPECT_NEAR(found.tracks[0].rate_px_per_s.y_px, -2.4 / 5, 0.02);
  // Its light, by which magnitudes are: of SNR 12 in each frame.
  EXPECT_NEAR(found.tracks[0].detection.signal_e / SimulatedSequence::flux_e(12), 1.0, 0.12);
}

TEST(DetectSequence, FindsInTheSumWhatNoFrameShows) {
  SimulatedSequence scene{.fixed = false, .frames = 10};
  scene.add = object_at({100.0, 150.0}, {2.3, 1.1}, 3, scene.frames / 2);
  const auto frames = scene.draw();
  EXPECT_TRUE(found_in(frames).tracks.empty());
  const auto found = found_in(frames, true);
  ASSERT_EQ(found.tracks.size(), 1U);
  EXPECT_TRUE(is_at(found.tracks[0], {100.0, 150.0}, 1.0));
  EXPECT_TRUE(found.tracks[0].by_stack);
  EXPECT_NEAR(found.tracks[0].detection.snr, 3 * std::sqrt(10.0), 2.5);
}

TEST(DetectSequence, HotPixelsAreNoObjects) {
  SimulatedSequence scene{.fixed = true};
  scene.spoil = [](CountImage& counts, int) {
    for (int i = 0; i < 20; ++i)  // 3 to 100 of a pixel's noise, which is 63 counts
      counts.at(20 + 11 * i, 40 + 9 * i) += std::uint16_t(190 * std::pow(1.2, i));
  };
  EXPECT_TRUE(found_in(scene.draw(), true).tracks.empty());
}

TEST(DetectSequence, CosmicRaysAreNoObjects) {
  SimulatedSequence scene{.fixed = false};
  scene.spoil = [](CountImage& counts, int frame) {
    for (int i = 0; i < 8; ++i)
      counts.at(30 + (i * 53 + frame * 97) % 200, 30 + (i * 71 + frame * 41) % 200) +=
          std::uint16_t(600 + 900 * i);
  };
  EXPECT_TRUE(found_in(scene.draw(), true).tracks.empty());
}

TEST(DetectSequence, ASaturatedStarIsNoObject) {
  for (const bool fixed : {true, false}) {
    SimulatedSequence scene{.fixed = fixed};
    const PixelPosition middle{128, 128};
    const Wcs at = scene.header(scene.frames / 2).wcs;
    scene.add = [&](SimulatedFrame& frame, int) {
      const auto here = wcs_pixel(frame.header().wcs, wcs_direction(at, middle));
      frame.add_star(here->x_px, here->y_px, 3e6);
    };
    EXPECT_TRUE(found_in(scene.draw(), true).tracks.empty());
  }
}

TEST(DetectSequence, FramesWithoutAWcsAreRegisteredByTheirStars) {
  SimulatedSequence scene{.fixed = true};
  scene.add = object_at({120.3, 90.7}, {0.3, 0.2}, 12, scene.frames / 2);
  auto frames = scene.draw();
  for (SequenceFrame& frame : frames) frame.header.unknown.add(FrameFact::pointing);
  const auto found = found_in(frames);
  ASSERT_EQ(found.tracks.size(), 1U);
  EXPECT_TRUE(is_at(found.tracks[0], {120.3, 90.7}, 0.3));
  const auto line = nlohmann::json::parse(to_json(found.tracks[0], 1));
  EXPECT_TRUE(line["ra_deg"].is_null());
  EXPECT_TRUE(line["sequence"]["rate_ra_arcsec_per_s"].is_null());
  EXPECT_FALSE(line["sequence"]["rate_px_per_s"][0].is_null());
}

TEST(DetectSequence, FramesWithoutAWcsAndStarsAreRefusedByName) {
  SimulatedSequence scene{.fixed = true, .stars = 0};
  auto frames = scene.draw();
  for (SequenceFrame& frame : frames) frame.header.unknown.add(FrameFact::pointing);
  try {
    found_in(frames);
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(std::string(e.what()).find("frame-0: shares too few stars"), 0U) << e.what();
  }
}

TEST(DetectSequence, OtherFieldsAreNotTakenForShiftedOnes) {
  // 500 stars a frame, of which some lie on others after any shift.
  SimulatedSequence one{.fixed = false, .frames = 3, .stars = 500};
  auto frames = one.draw();
  SimulatedSequence other{.fixed = false, .frames = 3, .stars = 500, .field = 8};
  frames[2].counts = other.draw()[2].counts;
  const auto notes = found_in(frames).notes;
  ASSERT_FALSE(notes.empty());
  EXPECT_EQ(notes[0].find("sequence: frame-2: shares too few stars"), 0U) << notes[0];
  for (SequenceFrame& frame : frames) frame.header.unknown.add(FrameFact::pointing);
  EXPECT_THROW(found_in(frames), Error);
}

TEST(DetectSequence, IsTheSameForAnyOrderOfFramesAndNumberOfThreads) {
  SimulatedSequence scene{.fixed = false, .frames = 6};
  scene.add = object_at({130.0, 110.0}, {6.2, -2.4}, 9, scene.frames / 2);
  auto frames = scene.draw();
  const auto one = found_in(frames, true, 1);
  std::reverse(frames.begin(), frames.end());
  const auto other = found_in(frames, true, 3);
  ASSERT_EQ(one.tracks.size(), 1U);
  ASSERT_EQ(other.tracks.size(), 1U);
  EXPECT_EQ(to_json(one.tracks[0], 1), to_json(other.tracks[0], 1));
}

TEST(DetectSequence, ABrightObjectIsOneTrackOfTheLightThatAFrameShows) {
  for (const double snr : {60.0, 300.0}) {
    SimulatedSequence scene{.fixed = true};
    scene.add = object_at({130.0, 110.0}, {0.6, -0.4}, snr, scene.frames / 2);
    const auto frames = scene.draw();
    const auto found = found_in(frames, true);
    ASSERT_EQ(found.tracks.size(), 1U) << snr;
    Threads threads(1);
    const SequenceFrame& middle = frames[frames.size() / 2];
    const auto alone = detect(middle.counts, middle.header, nullptr, threads).detections;
    ASSERT_FALSE(alone.empty());
    EXPECT_NEAR(alone[0].x_px, found.tracks[0].detection.x_px, 0.1);
    EXPECT_NEAR(found.tracks[0].detection.signal_e / alone[0].signal_e, 1.0, 0.04);
    EXPECT_NEAR(alone[0].signal_e / SimulatedSequence::flux_e(snr), 1.0, 0.1);
  }
}

TEST(DetectSequence, StreaksThroughTwoFramesMakeNoTracks) {
  SimulatedSequence scene{.fixed = false};
  scene.add = [](SimulatedFrame& frame, int i) {
    if (i == 2) frame.add_streak(128, 128, 400, 0.5, 4e5);
    if (i == 5) frame.add_streak(120, 100, 400, 1.7, 2e5);
  };
  EXPECT_TRUE(found_in(scene.draw(), true).tracks.empty());
}

TEST(DetectSequence, ThreeFramesAreEnoughForBrightPoints) {
  SimulatedSequence scene{.fixed = false, .frames = 3};
  scene.add = object_at({130.0, 110.0}, {9.0, 4.0}, 15, scene.frames / 2);
  EXPECT_EQ(found_in(scene.draw(), true).tracks.size(), 1U);
}

}  // namespace
}  // namespace dmise
