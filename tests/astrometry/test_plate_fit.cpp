#include "core/astrometry/plate_fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"
#include "tests/astrometry/seen_plate.h"

namespace dmise {
namespace {

/// The error of a fit in its covariance's units and order.
std::vector<double> error_of(const PlateFit& fit, const PlateModel& truth) {
  const auto by = fit.model.camera_from_gcrs * truth.camera_from_gcrs.inverse();
  std::vector<double> e{0.5 * (by.m[2][1] - by.m[1][2]), 0.5 * (by.m[0][2] - by.m[2][0]),
                        0.5 * (by.m[1][0] - by.m[0][1])};
  if (fit.free.focal_length)
    e.push_back(std::log(fit.model.focal_length_px / truth.focal_length_px));
  if (fit.free.centre) {
    e.push_back(fit.model.centre.x_px - truth.centre.x_px);
    e.push_back(fit.model.centre.y_px - truth.centre.y_px);
  }
  if (fit.free.radial) e.push_back(fit.model.distortion[8]);
  for (int i = 0; i < distortion_size(fit.free.order); ++i)
    e.push_back(fit.model.distortion[std::size_t(i)] -
                (i < int(truth.distortion.size()) ? truth.distortion[std::size_t(i)] : 0.0));
  return e;
}

/// e^T C^-1 e, by Gauss' elimination.
double square_of(std::vector<double> e, std::vector<double> c) {
  const std::size_t n = e.size();
  std::vector<double> scale(n);
  for (std::size_t i = 0; i < n; ++i) scale[i] = 1 / std::sqrt(c[i * (n + 1)]);
  for (std::size_t i = 0; i < n; ++i) {
    e[i] *= scale[i];
    for (std::size_t j = 0; j < n; ++j) c[i * n + j] *= scale[i] * scale[j];
  }
  double sum = 0.0;
  for (std::size_t k = 0; k < n; ++k) {
    sum += e[k] * e[k] / c[k * (n + 1)];
    for (std::size_t i = k + 1; i < n; ++i) {
      const double f = c[i * n + k] / c[k * (n + 1)];
      e[i] -= f * e[k];
      for (std::size_t j = k; j < n; ++j) c[i * n + j] -= f * c[k * n + j];
    }
  }
  return sum;
}

struct FreeCase {
  const char* name;
  double width_deg;
  PlateFreedom free;
};
void PrintTo(const FreeCase& c, std::ostream* out) { *out << c.name; }

class PlateCovariance : public ::testing::TestWithParam<FreeCase> {};

// Normal errors of 0.1 px on 250 stars, 150 plates each: the normalised estimation error squared
// over its number of unknowns is 1; its scatter with 600 unknowns and more is below 0.06.
TEST_P(PlateCovariance, IsTheErrorsOwn) {
  const PlateSky sky = test::sky_of(test::kstars());
  const PlateFreedom free = GetParam().free;
  double sum = 0.0;
  int unknowns = 0;
  for (unsigned seed = 1; seed <= 150; ++seed) {
    test::SeenPlate p = test::seen_plate(sky, {.width_deg = GetParam().width_deg}, 250, 0.1, seed);
    const SourceGrid grid(p.sources, p.belief.columns, p.belief.rows);
    const auto stars = sky.brightest(p.truth.axis(), 0.9 * GetParam().width_deg * deg, 2000);
    const auto matches =
        match(p.truth, stars, p.sources, grid, p.belief.columns, p.belief.rows, {.near_px = 0.6});
    PlateModel start = p.truth;
    start.camera_from_gcrs = turned(start.camera_from_gcrs, {1e-4, -2e-4, 3e-4});
    if (free.focal_length) start.focal_length_px *= 1.0003;
    const auto fit = fit_plate(start, matches, free);
    ASSERT_TRUE(fit);
    ASSERT_EQ(fit->free.size(), free.size());
    sum += square_of(error_of(*fit, p.truth), fit->covariance);
    unknowns += free.size();
  }
  std::printf("%s: NEES %.3f\n", GetParam().name, sum / unknowns);
  EXPECT_GT(sum / unknowns, 0.8);
  EXPECT_LT(sum / unknowns, 1.2);
}

INSTANTIATE_TEST_SUITE_P(
    Freedoms, PlateCovariance,
    ::testing::Values(FreeCase{"attitude", 20, {}},
                      FreeCase{"attitude and focal length", 20, {.focal_length = true}},
                      FreeCase{"centre, wide field", 70, {.focal_length = true, .centre = true}},
                      FreeCase{"radial distortion", 20, {.focal_length = true, .radial = true}},
                      FreeCase{"distortion", 20, {.focal_length = true, .order = 3}},
                      FreeCase{"distortion of order 5", 40, {.focal_length = true, .order = 5}}));

TEST(PlateFit, IsNotMovedByOutliers) {
  const PlateSky sky = test::sky_of(test::kstars());
  test::SeenPlate p = test::seen_plate(sky, {}, 200, 0.02, 3);
  const SourceGrid grid(p.sources, p.belief.columns, p.belief.rows);
  const auto stars = sky.brightest(p.truth.axis(), 0.4, 1000);
  auto matches =
      match(p.truth, stars, p.sources, grid, p.belief.columns, p.belief.rows, {.near_px = 0.5});
  for (std::size_t i = 0; i < matches.size(); i += 5) matches[i].pixel.x_px += 3;
  const auto fit = fit_plate(p.truth, matches, {.focal_length = true});
  ASSERT_TRUE(fit);
  EXPECT_LT(test::difference_px(p.truth, fit->model, 2000, 1500), 0.02);
  EXPECT_NEAR(fit->count, 0.8 * double(matches.size()), 3);
}

TEST(PlateFit, IsEmptyWithTooFewOrDependentStars) {
  const PlateSky sky = test::sky_of(test::kstars());
  const test::SeenPlate p = test::seen_plate(sky, {}, 50, 0.1, 3);
  std::vector<PlateMatch> matches;
  EXPECT_FALSE(fit_plate(p.truth, matches, {.focal_length = true}));
  const Vec<Gcrs> direction = *p.truth.direction({300, 300});
  matches.assign(1, {.pixel = {300, 300}, .covariance_px2 = {1, 0, 1}, .direction = direction});
  EXPECT_FALSE(fit_plate(p.truth, matches, {}));
  matches.assign(20, matches[0]);  // one star over and over
  EXPECT_FALSE(fit_plate(p.truth, matches, {.focal_length = true}));
}

}  // namespace
}  // namespace dmise
