#include "core/astrometry/deblend.h"

#include <gtest/gtest.h>

#include <cmath>

namespace dmise {
namespace {

Component box(int columns, int rows) {
  Component c{.max_x = columns - 1, .max_y = rows - 1, .pixels = columns * rows};
  for (int y = 0; y < rows; ++y) c.runs.push_back({y, 0, columns - 1});
  return c;
}

double peak(double x, double y, double x0, double y0, double height) {
  return height * std::exp(-0.5 * ((x - x0) * (x - x0) + (y - y0) * (y - y0)));
}

TEST(Deblend, SplitsTwoStarsAtTheirSaddle) {
  const auto parts = deblend(box(30, 20), 20, [](int x, int y) {
    return 1 + peak(x, y, 9, 10, 1000) + peak(x, y, 14, 10, 300);
  });
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(parts[0].peak_x, 9);
  EXPECT_EQ(parts[1].peak_x, 14);
  EXPECT_LT(parts[0].max_x, parts[1].min_x);
}

TEST(Deblend, FindsEveryOneOfFiveStars) {
  const auto parts = deblend(box(60, 60), 20, [](int x, int y) {
    double sum = 1;
    for (int i = 0; i < 5; ++i) sum += peak(x, y, 10 + 9 * i, 12 + 7 * i, 200.0 * (i + 1));
    return sum;
  });
  ASSERT_EQ(parts.size(), 5u);
}

TEST(Deblend, LeavesOneStarAndItsNoise) {
  for (const double noise : {0.0, 4.0}) {
    const auto parts = deblend(box(30, 20), 5 * noise, [&](int x, int y) {
      return 30 + peak(x, y, 15, 10, 500) + noise * std::sin(12.9 * x + 78.2 * y);
    });
    ASSERT_EQ(parts.size(), 1u);
    EXPECT_EQ(parts[0].pixels, 600);
  }
}

TEST(Deblend, ReturnsAPlateauAndASmallComponentAsTheyAre) {
  EXPECT_EQ(deblend(box(40, 40), 0, [](int, int) { return 5e4; }).size(), 1u);
  EXPECT_EQ(deblend(box(2, 2), 0, [](int x, int y) { return 1.0 + 100 * x + y; }).size(), 1u);
}

}  // namespace
}  // namespace dmise
