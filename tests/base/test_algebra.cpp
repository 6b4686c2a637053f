#include <gtest/gtest.h>

#include <cmath>

#include "core/base/algebra/positive_matrix.h"
#include "core/base/algebra/small_matrix.h"
#include "core/base/algebra/symmetric2.h"
#include "core/base/algebra/two_unknowns.h"

// References: numpy 1.24, linalg.inv, linalg.eigh, linalg.solve and polyfit of these numbers.
namespace dmise {
namespace {

constexpr Symmetric2 ellipse{4.0, 1.2, 1.0};

TEST(Symmetric2, InverseAndFormsAreThoseOfNumpy) {
  const auto [xx, xy, yy] = inverse_of(ellipse);
  EXPECT_NEAR(xx, 0.390625, 1e-15);
  EXPECT_NEAR(xy, -0.46875, 1e-15);
  EXPECT_NEAR(yy, 1.5625, 1e-15);
  EXPECT_NEAR(quadratic_form(ellipse, 0.3, -2.0), 2.92, 1e-14);
  EXPECT_NEAR(mahalanobis2(ellipse, 0.3, -2.0), 6.84765625, 1e-13);
}

TEST(Symmetric2, AxesAreItsEigenvectors) {
  EXPECT_NEAR(mean_of_axes(ellipse) + half_of_axes(ellipse), 4.42093727, 1e-8);
  EXPECT_NEAR(mean_of_axes(ellipse) - half_of_axes(ellipse), 0.57906273, 1e-8);
  EXPECT_NEAR(std::tan(axis_angle_rad(ellipse)), 0.33100694 / 0.94362832, 1e-7);
}

TEST(TwoUnknowns, AWeightedLineIsThatOfNumpy) {
  constexpr double x[] = {0, 1, 2, 4, 7}, y[] = {1, 2.9, 5.2, 8.8, 15.1},
                   sigma[] = {0.1, 0.2, 0.1, 0.3, 0.2};
  TwoSums sums{};
  for (int i = 0; i < 5; ++i) add_row(1.0, x[i], y[i], 1 / (sigma[i] * sigma[i]), sums);
  const auto [offset, slope] = solution_of(sums);
  EXPECT_NEAR(offset, 1.0428997, 1e-7);
  EXPECT_NEAR(slope, 2.01479643, 1e-8);
}

TEST(TwoUnknowns, WithoutTheSecondTheFirstIsAMean) {
  TwoSums sums{};
  add_row(1.0, 5.0, 2.0, 1.0, sums);
  add_row(1.0, 7.0, 5.0, 2.0, sums);
  EXPECT_EQ(solution_of(sums, false), (std::array{4.0, 0.0}));
}

TEST(PositiveMatrix, InverseIsThatOfNumpy) {
  std::vector<double> matrix{4, 1, 0.5, 1, 3, -0.2, 0.5, -0.2, 2};
  ASSERT_TRUE(invert_positive(matrix, 3));
  const double expected[] = {0.28530397, -0.10052657, -0.08137865, -0.10052657, 0.3709909,
                             0.06223073, -0.08137865, 0.06223073,  0.52656774};
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(matrix[i], expected[i], 1e-8);
}

TEST(PositiveMatrix, ASingularOneIsRefused) {
  std::vector<double> singular{1, 2, 2, 4}, negative{-1, 0, 0, 1};
  EXPECT_FALSE(invert_positive(singular, 2));
  EXPECT_FALSE(invert_positive(negative, 2));
}

TEST(SmallMatrix, SolutionIsThatOfNumpy) {
  SmallMatrix factor{};
  factor[0] = {4}, factor[1] = {1, 3}, factor[2] = {0.5, -0.2, 2};  // the lower triangle
  ASSERT_TRUE(cholesky(factor, 3));
  const SmallVector x = solve(factor, {1, 2, 3}, 3);
  EXPECT_NEAR(x[0], -0.15988511, 1e-8);
  EXPECT_NEAR(x[1], 0.82814744, 1e-8);
  EXPECT_NEAR(x[2], 1.62278602, 1e-8);
  EXPECT_NEAR(inverse_column(factor, 1, 3)[2], 0.06223073, 1e-8);
}

TEST(SmallMatrix, AnIndefiniteOneIsRefused) {
  SmallMatrix indefinite{};
  indefinite[0] = {1}, indefinite[1] = {2, 1};
  EXPECT_FALSE(cholesky(indefinite, 2));
}

}  // namespace
}  // namespace dmise
