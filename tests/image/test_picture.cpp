#include "core/image/charts/picture.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/image/charts/drawing.h"
#include "core/image/charts/font.h"
#include "core/image/charts/marked_picture.h"
#include "tests/image/sample_frame.h"

namespace dmise {
namespace {

using test::sample_counts;
using test::sample_header;

TEST(Preview, SkyIsDarkNoiseAndStarsShow) {
  CountImage counts = sample_counts(800, 600);  // 300 .. 363
  counts.at(400, 300) = 400;
  counts.at(100, 100) = 20000;
  const Preview p = preview(counts);
  EXPECT_EQ(p.picture.columns, 800);
  double mean = 0;
  for (const auto v : p.picture.pixels) mean += v;
  mean /= double(p.picture.pixels.size());
  EXPECT_GT(mean, 10);
  EXPECT_LT(mean, 60);
  EXPECT_GT(p.picture.pixels[300 * 800 + 400], mean + 20);
  EXPECT_EQ(p.picture.pixels[100 * 800 + 100], 255);
}

// A satellite that fills a tenth of a frame without sky: its brighter half must not look like its
// darker one, nor be lost beside a glint of a few pixels.
TEST(Preview, AnObjectThatFillsAPartOfTheFrameKeepsItsShades) {
  CountImage counts(640, 480, 100);
  for (int y = 150; y < 300; ++y)
    for (int x = 200; x < 400; ++x) counts.at(x, y) = x < 300 ? 8000 : 20000;
  for (int x = 200; x < 220; ++x) counts.at(x, 200) = 60000;
  const Preview p = preview(counts);
  const int sky = p.picture.pixels[10 * 640 + 10], dark = p.picture.pixels[160 * 640 + 250],
            bright = p.picture.pixels[160 * 640 + 350];
  EXPECT_LT(sky, 60);
  EXPECT_GT(dark, sky + 60);
  EXPECT_GT(bright, dark + 30);
  EXPECT_GT(bright, 200);
}

TEST(Preview, LargeFramesShrinkSmallOnesGrowAndPlacesFollow) {
  const Preview half = preview(CountImage(3326, 2504, 500));
  EXPECT_EQ(half.picture.columns, 1663);
  EXPECT_EQ(half.picture.rows, 1252);
  EXPECT_DOUBLE_EQ(half.place(0.5), 0.0);  // the first four pixels' common corner
  const Preview tripled = preview(CountImage(200, 150, 500));
  EXPECT_EQ(tripled.picture.columns, 600);
  EXPECT_DOUBLE_EQ(tripled.place(0.0), 1.0);
  EXPECT_EQ(preview(CountImage(1, 1, 0)).picture.rows, 640);
}

TEST(Drawing, StaysInsideWhateverIsAsked) {
  Picture picture = to_rgb(Picture{30, 20, 1, std::vector<std::uint8_t>(600, 0)});
  const Colour white = {255, 255, 255};
  draw_line(picture, -1e9, -1e9, 1e9, 1e9, white);
  draw_line(picture, 0, 5, std::nan(""), 5, white);
  draw_circle(picture, 10, 10, 1e12, white);
  draw_circle(picture, -5, -5, 3, white);
  draw_capsule(picture, 1e8, 3, -1e8, 4, 5, white);
  draw_text(picture, -3, 17, "a\xff", white, 2);
  EXPECT_EQ(picture.pixels.size(), 1800u);
}

TEST(Font, EveryPrintableCharacterIsItsOwn) {
  std::vector<std::array<std::uint8_t, glyph_rows>> seen;
  for (char c = ' '; c <= '~'; ++c) {
    for (const auto& other : seen) EXPECT_NE(glyph(c), other) << c;
    seen.push_back(glyph(c));
  }
}

TEST(MarkedPicture, ShowsTruthAndDetectionsInTheirColours) {
  Detection streak;
  streak.kind = DetectionKind::streak;
  streak.x_px = 100;
  streak.y_px = 75;
  streak.end1_x_px = 50;
  streak.end2_x_px = 150;
  streak.end1_y_px = streak.end2_y_px = 75;
  Truth truth;
  truth.in_frame = true;
  truth.start_x_px = 50;
  truth.end_x_px = 150;
  truth.middle_x_px = 100;
  truth.start_y_px = truth.middle_y_px = truth.end_y_px = 75;
  const Preview p = preview(sample_counts());
  const Picture picture = marked_picture(p, sample_header(), {truth}, {streak});
  EXPECT_EQ(picture.channels, 3);
  EXPECT_GT(picture.rows, p.picture.rows);
  int green = 0, cyan = 0;
  for (std::size_t i = 0; i < picture.pixels.size(); i += 3) {
    const auto r = picture.pixels[i], g = picture.pixels[i + 1], b = picture.pixels[i + 2];
    green += g > 200 && r < 100 && b < 120;
    cyan += g > 200 && b > 200 && r < 120;
  }
  EXPECT_GT(green, 600);
  EXPECT_GT(cyan, 600);
}

}  // namespace
}  // namespace dmise
