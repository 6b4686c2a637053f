#include "core/astrometry/zero_point.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace dmise {
namespace {

std::vector<PhotometricStar> stars_of(std::size_t count, double sigma_mag, unsigned seed,
                                      double airmass_range = 2.0) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const auto uniform = [&] { return double(random() >> 11) * 0x1p-53; };
  std::vector<PhotometricStar> stars;
  for (std::size_t i = 0; i < count; ++i) {
    PhotometricStar s{.sigma_mag = sigma_mag,
                      .v_mag = 4 + 5 * uniform(),
                      .bv = -0.2 + 1.8 * uniform(),
                      .airmass = 1 + airmass_range * uniform()};
    s.instrumental_mag = s.v_mag - 17.25 - 0.12 * (s.bv - ZeroPoint::sunlike_bv) +
                         0.21 * s.airmass + sigma_mag * normal(random);
    stars.push_back(s);
  }
  return stars;
}

TEST(ZeroPoint, ItsErrorsAreAsStated) {
  double sum[3] = {0, 0, 0};
  constexpr int frames = 300;
  for (unsigned seed = 0; seed < frames; ++seed) {
    const auto z = fit_zero_point(stars_of(120, 0.03, seed), 0.5);
    ASSERT_TRUE(z && z->colour_fitted && z->extinction_fitted);
    sum[0] += std::pow((z->zero_point_mag - 17.25) / z->sigma(0), 2);
    sum[1] += std::pow((z->colour_term - 0.12) / z->sigma(1), 2);
    sum[2] += std::pow((z->extinction_mag_per_airmass - 0.21) / z->sigma(2), 2);
  }
  // The mean square of one unknown over 300 frames is 1 +- 0.08.
  for (const double s : sum) {
    EXPECT_GT(s / frames, 0.75);
    EXPECT_LT(s / frames, 1.25);
  }
}

TEST(ZeroPoint, IsNotMovedByVariablesAndBlends) {
  auto stars = stars_of(200, 0.02, 5);
  for (std::size_t i = 0; i < stars.size(); i += 6) stars[i].instrumental_mag -= 0.4 + 0.01 * i;
  const auto z = fit_zero_point(stars, 0.0);
  ASSERT_TRUE(z);
  EXPECT_NEAR(z->zero_point_mag, 17.25, 0.02);
  EXPECT_NEAR(z->colour_term, 0.12, 0.01);
  EXPECT_NEAR(z->extinction_mag_per_airmass, 0.21, 0.01);
  EXPECT_LT(z->stars, 170);
}

TEST(ZeroPoint, KeepsTheBelievedExtinctionWhereAirmassesAreAlike) {
  const auto z = fit_zero_point(stars_of(100, 0.02, 6, 0.05), 0.21);
  ASSERT_TRUE(z);
  EXPECT_FALSE(z->extinction_fitted);
  EXPECT_EQ(z->sigma(2), 0.0);
  EXPECT_EQ(z->extinction_mag_per_airmass, 0.21);
  EXPECT_NEAR(z->zero_point_mag, 17.25, 0.02);
}

// Light that scintillates by a log-normal factor of mean 1, with a variance that goes as the third
// power of the airmass: the mean of its magnitudes is 0.02 mag too faint at the zenith and 0.3 at
// an airmass of 2.5.
TEST(ZeroPoint, ScintillationMovesItLittle) {
  double sum = 0.0, sum_k = 0.0, squares = 0.0;
  constexpr int frames = 40;
  for (unsigned seed = 0; seed < frames; ++seed) {
    auto stars = stars_of(600, 0.02, seed, 1.5);
    std::mt19937_64 random(seed + 1000);
    std::normal_distribution<double> normal;
    for (PhotometricStar& s : stars) {
      const double variance = std::log1p(0.015 * std::pow(s.airmass, 3));
      s.instrumental_mag -=
          2.5 / std::log(10.0) * (std::sqrt(variance) * normal(random) - 0.5 * variance);
    }
    const auto z = fit_zero_point(stars, std::nullopt);
    ASSERT_TRUE(z && z->extinction_fitted);
    sum += z->zero_point_mag - 17.25;
    sum_k += z->extinction_mag_per_airmass - 0.21;
    squares += std::pow((z->zero_point_mag - 17.25) / z->sigma(0), 2);
  }
  EXPECT_LT(std::abs(sum / frames), 0.02);
  EXPECT_LT(std::abs(sum_k / frames), 0.02);
  EXPECT_LT(squares / frames, 2.0);
}

TEST(ZeroPoint, KeepsTheBelievedExtinctionIfTheStarsDetermineItWorse) {
  const auto stars = stars_of(100, 0.05, 7, 0.6);
  const auto believed = fit_zero_point(stars, 0.21), unknown = fit_zero_point(stars, std::nullopt);
  ASSERT_TRUE(believed && unknown);
  EXPECT_FALSE(believed->extinction_fitted);
  EXPECT_EQ(believed->extinction_mag_per_airmass, 0.21);
  EXPECT_NEAR(believed->zero_point_mag, 17.25, 3 * believed->sigma(0));
  EXPECT_TRUE(unknown->extinction_fitted);
  EXPECT_NEAR(unknown->extinction_mag_per_airmass, 0.21, 3 * unknown->sigma(2));
}

TEST(ZeroPoint, OfFewStarsIsTheirMedianAndOfNoneEmpty) {
  EXPECT_FALSE(fit_zero_point({}, 0.2));
  for (std::size_t n = 1; n < 6; ++n) {
    const auto z = fit_zero_point(stars_of(n, 0.01, unsigned(n)), 0.21);
    ASSERT_TRUE(z);
    EXPECT_FALSE(z->colour_fitted);
    EXPECT_NEAR(z->zero_point_mag, 17.25, 0.2);
    EXPECT_GT(z->sigma(0), 0.0);
  }
}

}  // namespace
}  // namespace dmise
