#include "core/base/algebra/banded_matrix.h"

#include <gtest/gtest.h>

namespace dmise {
namespace {

/// Second differences with a diagonal of 2 + `more`: its band is 1.
BandedMatrix differences(std::size_t size, double more) {
  BandedMatrix out(size, 1);
  for (std::size_t i = 0; i < size; ++i) {
    out.at(i, i) = 2 + more;
    if (i > 0) out.at(i, i - 1) = -1;
  }
  return out;
}

// The inverse of second differences of size n: min(i, j) (n + 1 - max(i, j)) / (n + 1), from 1.
TEST(BandedMatrix, SolvesSecondDifferences) {
  constexpr std::size_t n = 9;
  BandedMatrix factor = differences(n, 0.0);
  ASSERT_TRUE(factor.factorise());
  for (std::size_t i = 1; i <= n; ++i) {
    std::vector<double> one(n, 0.0);
    one[i - 1] = 1.0;
    const auto column = factor.solve(one);
    for (std::size_t j = 1; j <= n; ++j)
      EXPECT_NEAR(column[j - 1],
                  double(std::min(i, j)) * double(n + 1 - std::max(i, j)) / double(n + 1), 1e-12);
  }
}

TEST(BandedMatrix, TimesTheSolutionIsTheRightSide) {
  const BandedMatrix matrix = differences(40, 0.5);
  BandedMatrix factor = matrix;
  ASSERT_TRUE(factor.factorise());
  std::vector<double> right;
  for (int i = 0; i < 40; ++i) right.push_back(i % 7 - 3.0);
  const auto back = matrix.times(factor.solve(right));
  for (std::size_t i = 0; i < right.size(); ++i) EXPECT_NEAR(back[i], right[i], 1e-12);
}

TEST(BandedMatrix, RefusesWhatIsNotPositiveDefinite) {
  BandedMatrix matrix = differences(5, -2.5);
  EXPECT_FALSE(matrix.factorise());
}

}  // namespace
}  // namespace dmise
