#include "core/ingest/detector_defects.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/ingest/foreign_scene.h"

namespace dmise {
namespace {

using namespace test;
using testing::Contains;
using testing::HasSubstr;

std::size_t unusable_in(const Frame& frame, int x0, int x1) {
  std::size_t pixels = 0;
  for (int y = 0; y < frame.unusable.rows; ++y)
    for (int x = x0; x <= x1; ++x) pixels += frame.unusable.at(x, y);
  return pixels;
}

// As an amplifier's glow: 9, 3 and 2.5 sigma of the sky in the first three columns.
TEST(DetectorDefects, ABrightEdgeColumnIsNoStreak) {
  const Scene scene = draw(false, 4);
  ForeignImage image = image_of(scene.counts, all_cards(scene.header));
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < 3; ++x)
      image.values[std::size_t(y * columns + x)] += x == 0 ? 300 : x == 1 ? 100 : 80;
  const Frame frame = read_one(image);
  EXPECT_EQ(unusable_in(frame, 0, 2), std::size_t(3 * rows));
  EXPECT_EQ(unusable_in(frame, 3, columns - 1), 0u);
  EXPECT_THAT(frame.notes.assumed, Contains(HasSubstr("the first 3 and the last 0 columns")));
  EXPECT_EQ(detections_in(frame).size(), 2u);
}

TEST(DetectorDefects, OverscanIsNotUsed) {
  const Scene scene = draw(false, 4);
  ForeignImage image = image_of(scene.counts, all_cards(scene.header));
  for (int y = 0; y < rows; ++y)
    for (int x = 460; x < columns; ++x) image.values[std::size_t(y * columns + x)] = 100 + y % 7;
  image.cards.push_back(card("DATASEC", "'[1:460,1:400]'"));
  const Frame frame = read_one(image);
  EXPECT_EQ(unusable_in(frame, 460, columns - 1), std::size_t(40 * rows));
  EXPECT_EQ(detections_in(frame).size(), 2u);
  image.cards.back() = card("TRIMSEC", "' [ 460 : 1 , 1 : +400 ] '");  // flipped, with blanks
  EXPECT_EQ(unusable_in(read_one(image), 460, columns - 1), std::size_t(40 * rows));
  // Sections of the frame before it was cut, and texts that are no section.
  for (const char* text :
       {"'[51:2098,1:4608]'", "'[0:460,1:400]'", "'[-2147483648:460,1:400]'",
        "'[1:99999999999,1:400]'", "'[1:460,1:400'", "'[1:460;1:400]'", "'[1:460,1:400]x'", "'[,]'",
        "'[]'", "'['", "'[1:4:460,1:400]'", "'460'"}) {
    image.cards.back() = card("DATASEC", text);
    for (const std::string& note : read_one(image).notes.assumed)
      EXPECT_THAT(note, testing::Not(HasSubstr("DATASEC"))) << text;
  }
}

// The section of the overscan counts where none tells that of the sky.
TEST(DetectorDefects, WhatIsOverscanIsNotUsed) {
  const Scene scene = draw(false, 4);
  ForeignImage image = image_of(scene.counts, all_cards(scene.header));
  for (int y = 0; y < rows; ++y)
    for (int x = 460; x < columns; ++x) image.values[std::size_t(y * columns + x)] = 100 + y % 7;
  image.cards.push_back(card("BIASSEC", "'[461:500,1:400]'"));
  const Frame frame = read_one(image);
  EXPECT_EQ(unusable_in(frame, 460, columns - 1), std::size_t(40 * rows));
  EXPECT_EQ(unusable_in(frame, 0, 459), 0u);
  EXPECT_THAT(frame.notes.assumed, Contains(HasSubstr("those in BIASSEC [461:500,1:400]")));
  EXPECT_EQ(detections_in(frame).size(), 2u);
  image = image_of(scene.counts, all_cards(scene.header));
  for (const char* text : {"'[101:500,1:400]'", "'[461:501,1:400]'", "'[0:0,0:0]'"}) {
    image.cards.push_back(card("BIASSEC", text));
    EXPECT_TRUE(read_one(image).unusable.pixels.empty()) << text;
    image.cards.pop_back();
  }
  // Sections of the frame before it was cut, as its DATASEC tells.
  image.cards.push_back(card("DATASEC", "'[41:540,1:400]'"));
  image.cards.push_back(card("BIASSEC", "'[1:40,1:400]'"));
  EXPECT_TRUE(read_one(image).unusable.pixels.empty());
}

// A star of 8 times the full well, whose charge fills its column and falls off beyond.
TEST(DetectorDefects, ChargeThatFlowedAlongAColumnIsNoStreak) {
  FrameHeader h = simulated::camera_header(columns, rows, focal_px, 0.4, 4, false);
  h.full_well_e = 60000;
  simulated::SimulatedFrame drawn(h, columns, rows, 200, 3);
  drawn.add_stars(150, 1500, 60000);
  drawn.add_streak(150, 300, 60, 0.5, 30000);
  drawn.add_star(330, 120, 8e6);
  ForeignImage image = image_of(drawn.expose(), all_cards(h));
  for (double& v : image.values) v = std::min(v, 64000.0);
  for (int k = -60; k <= 60; ++k)
    for (int x = 330; x <= 331; ++x) {
      double& v = image.values[std::size_t((120 + k) * columns + x)];
      v = std::max(v, std::abs(k) < 45 ? 64000.0 : 64000.0 * std::exp(-0.4 * (std::abs(k) - 45)));
    }
  const Frame frame = read_one(image);
  EXPECT_THAT(frame.notes.assumed, Contains(HasSubstr("have charge that flowed")));
  EXPECT_EQ(detections_in(frame).size(), 1u);
}

// A frame of dawn: looking along each clipped pixel's whole line takes an hour.
TEST(DetectorDefects, AFrameThatIsSaturatedEverywhereHasNoStarWhoseChargeFlowed) {
  constexpr int side = 4000;
  Frame frame;
  frame.counts = CountImage(side, side);
  frame.counts.pixels.assign(frame.counts.pixels.size(), 65535);
  frame.header.saturation_dn = 65000;
  Threads threads(2);
  leave_out_bleeding(frame, threads);
  EXPECT_TRUE(frame.notes.assumed.empty());
}

// Single pixels of an SNR of 20 to 300, as in a frame without a dark; all stars stay.
TEST(DetectorDefects, HotPixelsAreNoLight) {
  const Scene scene = draw(false, 4);
  const Frame clean = read_one(image_of(scene.counts, all_cards(scene.header)));
  EXPECT_TRUE(clean.unusable.pixels.empty());
  ForeignImage image = image_of(scene.counts, all_cards(scene.header));
  std::mt19937_64 random(5);
  for (int i = 0; i < 60; ++i) {
    const auto at = std::size_t(random() % std::uint64_t(columns * rows));
    image.values[at] = std::min(image.values[at] + 600 + double(random() % 9000), 60000.0);
  }
  const Frame frame = read_one(image);
  EXPECT_GT(unusable_in(frame, 0, columns - 1), 45u);
  EXPECT_EQ(detections_in(frame).size(), 2u);
}

}  // namespace
}  // namespace dmise
