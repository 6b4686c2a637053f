#include "core/detection/light/trail_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/base/units.h"

namespace dmise {
namespace {

constexpr double sigma_px = 0.8;
constexpr double sky_variance_e2 = 400.0;

double light(const std::vector<Trail>& trails, double x, double y) {
  double sum = 0.0;
  for (const Trail& t : trails) sum += trail_value(t, sigma_px, x, y);
  return sum;
}

std::vector<FitPixel> field(const std::vector<Trail>& trails, int size, std::mt19937_64* random) {
  std::vector<FitPixel> out;
  std::normal_distribution<double> normal;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const double mean = light(trails, x, y);
      const double noise = random ? std::sqrt(mean + sky_variance_e2) * normal(*random) : 0.0;
      out.push_back({x, y, float(mean + noise), float(sky_variance_e2)});
    }
  return out;
}

FitSettings settings() {
  FitSettings s;
  s.psf = sigma_px;
  s.max_steps = 40;
  return s;
}

TEST(TrailFit, LightOfATrailSumsToItsFlux) {
  for (const double length : {0.0, 0.5, 7.0, 40.0})
    for (const double angle : {0.0, 0.3, 1.2}) {
      const Trail t{
          40.2, 40.7, 1000.0, length, angle, length > 5 ? 0.4 : 0.0, length > 20 ? 1.0 : 0.0};
      double sum = 0.0;
      for (const FitPixel& p : field({t}, 81, nullptr)) sum += p.signal_e;
      EXPECT_NEAR(sum, 1000.0, 1.0) << length << " " << angle;
    }
}

TEST(TrailFit, FindsWhatMadeTheLight) {
  const Trail truth{30.3, 28.6, 60000.0, 35.0, 0.6, 0.2, 0.8};
  Trail start = truth;
  start.x_px += 1.2;
  start.y_px -= 0.9;
  start.length_px -= 4;
  start.angle_rad += 0.05;
  start.flux_e *= 0.8;
  start.slope = start.sagitta_px = 0.0;
  const auto fit = fit_trails(field({truth}, 61, nullptr), {start}, {trail_bent_line}, settings());
  const Trail& found = fit.trails[0];
  EXPECT_TRUE(fit.converged);
  EXPECT_NEAR(found.x_px, truth.x_px, 1e-3);
  EXPECT_NEAR(found.y_px, truth.y_px, 1e-3);
  EXPECT_NEAR(found.flux_e, truth.flux_e, 10);
  EXPECT_NEAR(found.length_px, truth.length_px, 3e-3);
  EXPECT_NEAR(found.angle_rad, truth.angle_rad, 1e-4);
  EXPECT_NEAR(found.slope, truth.slope, 1e-3);
  EXPECT_NEAR(found.sagitta_px, truth.sagitta_px, 1e-3);
}

TEST(TrailFit, TellsTwoSourcesApart) {
  const std::vector<Trail> truth = {{10.2, 9.9, 5000.0}, {12.4, 10.6, 3000.0}};
  std::vector<Trail> start = truth;
  start[0].x_px -= 0.4;
  start[1].y_px += 0.4;
  const auto fit =
      fit_trails(field(truth, 23, nullptr), start, {trail_place, trail_place}, settings());
  EXPECT_NEAR(fit.trails[0].flux_e, 5000, 5);
  EXPECT_NEAR(fit.trails[1].flux_e, 3000, 5);
}

// Errors of all free parameters against the covariance: mean of chi2 / parameters is 1 with a
// standard deviation of sqrt(2 / (parameters x trials)).
TEST(TrailFit, CovarianceIsHonest) {
  std::mt19937_64 random(5);
  double nees = 0.0, chi2 = 0.0;
  const int trials = 400;
  for (int i = 0; i < trials; ++i) {
    const Trail truth{20 + 0.001 * i, 20 - 0.002 * i, 20000.0, 14.0, 0.01 * i, 0.0, 0.0};
    const auto fit = fit_trails(field({truth}, 41, &random), {truth}, {trail_line}, settings());
    const Trail& f = fit.trails[0];
    const double d[5] = {f.x_px - truth.x_px, f.y_px - truth.y_px, f.flux_e - truth.flux_e,
                         f.length_px - truth.length_px, f.angle_rad - truth.angle_rad};
    // Solve covariance z = d by elimination.
    double m[5][6];
    for (int r = 0; r < 5; ++r) {
      for (int c = 0; c < 5; ++c) m[r][c] = fit.cov(r, c);
      m[r][5] = d[r];
    }
    for (int p = 0; p < 5; ++p)
      for (int r = 0; r < 5; ++r) {
        if (r == p) continue;
        const double k = m[r][p] / m[p][p];
        for (int c = p; c < 6; ++c) m[r][c] -= k * m[p][c];
      }
    for (int r = 0; r < 5; ++r) nees += d[r] * m[r][5] / m[r][r] / 5;
    chi2 += fit.reduced_chi2();
  }
  EXPECT_NEAR(nees / trials, 1.0, 4 * std::sqrt(2.0 / (5 * trials)));
  EXPECT_NEAR(chi2 / trials, 1.0, 0.02);
}

// In white noise the best that any linear filter can do: SNR = F sqrt(sum of p^2) / s.
TEST(TrailFit, ErrorOfAFaintFluxIsTheMatchedFilters) {
  const Trail truth{20.0, 20.0, 1.0, 0.0};
  double squares = 0.0;
  const auto pixels = field({truth}, 41, nullptr);
  for (const FitPixel& p : pixels) squares += double(p.signal_e) * p.signal_e;
  const auto fit = fit_trails(pixels, {truth}, {trail_flux}, settings());
  EXPECT_NEAR(std::sqrt(fit.cov(0, 0)), std::sqrt(sky_variance_e2 / squares), 0.02);
}

}  // namespace
}  // namespace dmise
