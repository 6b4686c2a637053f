#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/base/numeric/monotone_cubic.h"

namespace dmise {
namespace {

// Against scipy: VignettingTable.IsScipysMonotoneInterpolation.
TEST(MonotoneCubic, GoesThroughItsPointsAndNeverBeyondThem) {
  const MonotoneCubic curve({0, 1, 3, 4}, {0, 0, 2, 2});
  for (std::size_t i = 0; i < curve.at().size(); ++i)
    EXPECT_DOUBLE_EQ(curve(curve.at()[i]), curve.value()[i]);
  double before = 0.0;
  for (int i = 0; i <= 400; ++i) {
    const double y = curve(0.01 * i);
    EXPECT_GE(y, before - 1e-15);
    EXPECT_LE(y, 2.0);
    before = y;
  }
}

TEST(MonotoneCubic, IsConstantOutsideAndWithOnePoint) {
  const MonotoneCubic line({1, 2}, {3, 5}), point({7.0}, {4.0});
  EXPECT_EQ(line(0.0), 3.0);
  EXPECT_EQ(line(9.0), 5.0);
  EXPECT_DOUBLE_EQ(line(1.5), 4.0);
  EXPECT_EQ(point(-1e9), 4.0);
  EXPECT_EQ(MonotoneCubic()(3.0), 0.0);
}

TEST(MonotoneCubic, RefusesPlacesThatDoNotRise) {
  EXPECT_THROW(MonotoneCubic({1, 1}, {0, 0}), Error);
  EXPECT_THROW(MonotoneCubic({1, 2}, {0}), Error);
  EXPECT_THROW(MonotoneCubic({0, std::numeric_limits<double>::infinity()}, {0, 0}), Error);
}

}  // namespace
}  // namespace dmise
