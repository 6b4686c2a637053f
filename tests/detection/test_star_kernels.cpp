#include "core/detection/light/star_kernels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "core/base/numeric/simd_level.h"
#include "core/detection/light/star_image.h"
#include "core/detection/pixels/bit_mask.h"
#include "core/detection/pixels/filtered_frame.h"
#include "tests/detection/filtered_step.h"

namespace dmise {
namespace {

struct Kernels {
  decltype(&sse2::draw_points) draw_points;
  decltype(&sse2::subtract_light) subtract_light;
  decltype(&sse2::bits_above) bits_above;
  decltype(&sse2::add_pixels) add_pixels;
};

std::vector<Kernels> levels() {
  std::vector<Kernels> out{
      {sse2::draw_points, sse2::subtract_light, sse2::bits_above, sse2::add_pixels}};
  if (best_simd_level() >= SimdLevel::avx2)
    out.push_back({avx2::draw_points, avx2::subtract_light, avx2::bits_above, avx2::add_pixels});
  if (best_simd_level() >= SimdLevel::avx512)
    out.push_back(
        {avx512::draw_points, avx512::subtract_light, avx512::bits_above, avx512::add_pixels});
  return out;
}

// Against the exponential function of the standard library, of boxes as wide as a vector, less and
// more.
TEST(StarKernels, DrawGaussiansAlikeOnEveryInstructionSet) {
  for (const std::size_t width : {7u, 16u, 41u}) {
    constexpr std::size_t rows = 19;
    const std::size_t stride = (width + star_lanes - 1) / star_lanes * star_lanes;
    const auto last = std::int32_t(width) - 1;
    const std::vector<StarPoint> points{{2.3F, 8.9F, 0, last, 0, 18}, {4.7F, 9.4F, 1, 5, 3, 15}};
    constexpr float each = 1234.5F, curvature = -0.31F;
    std::vector<float> first;
    for (const Kernels& kernels : levels()) {
      std::vector<float> light(stride * rows), by_x = light, by_y = light;
      std::vector<float> scratch(points.size() * (stride + rows + star_lanes));
      kernels.draw_points(points.data(), points.size(), each, curvature,
                          {stride, rows, light.data(), by_x.data(), by_y.data(), scratch.data()});
      if (first.empty()) first = light;
      EXPECT_EQ(light, first);
      for (std::size_t y = 0; y < rows; ++y)
        for (std::size_t x = 0; x < stride; ++x) {
          double value = 0.0, slope_x = 0.0, slope_y = 0.0;
          for (const StarPoint& p : points) {
            const auto i = std::int32_t(x), j = std::int32_t(y);
            if (i < p.left || i > p.right || j < p.top || j > p.bottom) continue;
            const double dx = double(x) - double(p.x_px), dy = double(y) - double(p.y_px);
            const double one = each * std::exp(double(curvature) * (dx * dx + dy * dy));
            value += one;
            slope_x -= 2 * double(curvature) * dx * one;
            slope_y -= 2 * double(curvature) * dy * one;
          }
          const std::size_t at = y * stride + x;
          // To a part in 10^5 of where there is light, and nothing far from it.
          EXPECT_NEAR(light[at], value, 1e-5 * value + 1e-9);
          EXPECT_NEAR(by_x[at], slope_x, 2e-5 * (std::abs(slope_x) + value) + 1e-9);
          EXPECT_NEAR(by_y[at], slope_y, 2e-5 * (std::abs(slope_y) + value) + 1e-9);
        }
    }
  }
}

TEST(StarKernels, SubtractAndMarkLightAlikeOnEveryInstructionSet) {
  constexpr std::size_t count = 61;
  std::mt19937_64 random(4);
  std::vector<std::int8_t> before;
  std::vector<float> light(64, 0.0F);
  for (std::size_t i = 0; i < count; ++i) {
    before.push_back(i % 9 == 0 ? std::int8_t(0) : std::int8_t(int(random() % 63) - 31));
    light[i] = float(random() % 1000) / 100.0F;
  }
  constexpr float hidden = 6.0F, lit = 4.0F;
  for (const Kernels& kernels : levels()) {
    std::vector<std::int8_t> steps = before;
    kernels.subtract_light(light.data(), hidden, count, true, steps.data());
    const std::uint64_t bits = kernels.bits_above(light.data(), count, lit);
    for (std::size_t i = 0; i < count; ++i) {
      const float left = float(before[i]) / FilteredFrame::steps - light[i];
      const bool gone = before[i] == 0 || light[i] > hidden;
      EXPECT_EQ(steps[i], gone ? 0 : test::step_of(left, i % 2 == 0)) << i;
      EXPECT_EQ(bits >> i & 1, light[i] > lit ? 1u : 0u) << i;
    }
    EXPECT_EQ(bits >> count, 0u);
  }
}

TEST(StarKernels, SumPixelsThatAreNumbersAlikeOnEveryInstructionSet) {
  constexpr std::size_t stride = 32, rows = 5;
  std::mt19937_64 random(7);
  std::normal_distribution<float> normal;
  std::vector<float> light, by_x, by_y, pixels;
  for (std::size_t i = 0; i < stride * rows; ++i) {
    light.push_back(std::abs(normal(random)));
    by_x.push_back(normal(random));
    by_y.push_back(normal(random));
    pixels.push_back(i % 3 == 0 ? NAN : light.back() + normal(random));
  }
  StarSums first;
  for (const Kernels& kernels : levels()) {
    StarSums sums;
    kernels.add_pixels(light.data(), by_x.data(), by_y.data(), pixels.data(), stride, rows, 0.02F,
                       0.03F, sums);
    if (first.used == 0) first = sums;
    EXPECT_EQ(sums.used, first.used);
    for (int a = 0; a < 3; ++a) EXPECT_EQ(sums.right[a], first.right[a]);
    for (int k = 0; k < 6; ++k) EXPECT_EQ(sums.matrix[k], first.matrix[k]);
  }
  double right = 0.0, matrix = 0.0;
  int used = 0;
  for (std::size_t i = 0; i < light.size(); ++i) {
    if (std::isnan(pixels[i])) continue;
    ++used;
    const double weight = 1 / (1 + 0.02 * light[i] + std::pow(0.03 * light[i], 2));
    right += weight * by_y[i] * (pixels[i] - light[i]);
    matrix += weight * by_y[i] * by_x[i];
  }
  EXPECT_EQ(first.used, used);
  EXPECT_NEAR(first.right[2], right, 1e-4);
  EXPECT_NEAR(first.matrix[4], matrix, 1e-4);
}

// All light of a star within the frame, as much as there is beyond a distance is missing.
TEST(StarKernels, AStarImageHasTheLightOfTheStar) {
  StarImage image(200, 100);
  Trail trail;
  trail.x_px = 81.3, trail.y_px = 40.7, trail.length_px = 23.0, trail.angle_rad = 0.4;
  image.draw(trail, 1.7, 5000.0, 1e-3);
  double sum = 0.0, x = 0.0;
  for (int j = image.y0; j <= image.y1; ++j)
    for (int i = image.x0; i <= image.x1; ++i) {
      sum += image.row(j)[i - image.x0];
      x += double(i) * image.row(j)[i - image.x0];
    }
  EXPECT_NEAR(sum, 5000.0, 2.0);
  EXPECT_NEAR(x / sum, 81.3, 1e-3);
}

TEST(BitMask, SetsAndVisitsBitsAcrossWords) {
  BitMask mask(200, 3);
  mask.set_bits(60, 1, 0b1010011);
  mask.set(199, 1);
  std::vector<int> set;
  mask.for_set(1, 61, 200, [&](int x) { set.push_back(x); });
  EXPECT_EQ(set, (std::vector<int>{61, 64, 66, 199}));
  mask.for_set(1, 0, 61, [&](int x) { EXPECT_EQ(x, 60); });
  mask.for_set(0, 0, 200, [&](int) { ADD_FAILURE(); });
}

}  // namespace
}  // namespace dmise
