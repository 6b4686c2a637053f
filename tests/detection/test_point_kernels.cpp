#include "core/detection/streaks/point_kernels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "tests/support/simd.h"

namespace dmise {
namespace {

class PointKernels : public testing::TestWithParam<SimdLevel> {
 protected:
  decltype(&sse2::weight_within) weight_within =
      kernel_of(GetParam(), sse2::weight_within, avx2::weight_within, avx512::weight_within);
};

/// Points of whole weights, whose sums have no rounding, the last block filled with none.
struct Cloud {
  std::vector<double> x, y, weight, after;

  explicit Cloud(std::size_t points) {
    std::mt19937_64 random(5);
    const std::size_t blocks = (points + point_block - 1) / point_block;
    for (std::size_t i = 0; i < blocks * point_block; ++i) {
      x.push_back(double(random() % 4000) / 8);
      y.push_back(double(random() % 4000) / 8);
      weight.push_back(i < points ? double(random() % 100) : 0.0);
    }
    after.assign(blocks + 1, 0.0);
    for (std::size_t b = blocks; b-- > 0;) {
      after[b] = after[b + 1];
      for (std::size_t i = b * point_block; i < (b + 1) * point_block; ++i) after[b] += weight[i];
    }
  }
  WeighedPoints points() const {
    return {x.data(), y.data(), weight.data(), after.data(), after.size() - 1};
  }
  double within(const PointLine& line, double width) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i)
      if (std::fabs((y[i] - line.y) * line.ux - (x[i] - line.x) * line.uy) < width)
        sum += weight[i];
    return sum;
  }
};

TEST_P(PointKernels, AddTheWeightsBesideALine) {
  for (const std::size_t count :
       {std::size_t(1), std::size_t(64), std::size_t(65), std::size_t(1000)}) {
    const Cloud cloud(count);
    for (int k = 0; k < 16; ++k) {
      const PointLine line{250.0 + k, 240.0 - k, std::cos(0.2 * k), std::sin(0.2 * k)};
      for (const double width : {0.0, 3.0, 40.0, 1e4})
        EXPECT_EQ(weight_within(cloud.points(), line, width, -1.0), cloud.within(line, width))
            << count << " points, line " << k << ", " << width << " px";
    }
  }
}

TEST_P(PointKernels, StopWhereTheRestCannotExceed) {
  const Cloud cloud(1000);
  const PointLine line{250, 250, 1, 0};
  const double all = cloud.within(line, 30.0);
  EXPECT_EQ(weight_within(cloud.points(), line, 30.0, all - 1), all);
  EXPECT_LE(weight_within(cloud.points(), line, 30.0, all), all);
  EXPECT_EQ(weight_within(cloud.points(), line, 30.0, 1e9), 0.0);
}

INSTANTIATE_TEST_SUITE_P(Sets, PointKernels, testing::ValuesIn(test::simd_here()), test::simd_name);

}  // namespace
}  // namespace dmise
