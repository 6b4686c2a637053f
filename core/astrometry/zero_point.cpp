#include "core/astrometry/zero_point.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/astrometry/normal_equations.h"
#include "core/base/quantile.h"

namespace dmise {
namespace {

constexpr double tukey = 4.685;  // 95 % efficient for normal errors
constexpr double least_scatter_mag = 0.002;

double spread(std::span<const PhotometricStar> stars, double PhotometricStar::*value) {
  std::vector<double> values;
  for (const PhotometricStar& s : stars) values.push_back(s.*value);
  return quantile_of(values, 0.95) - quantile_of(values, 0.05);
}

}  // namespace

double ZeroPoint::sigma(std::size_t i) const { return std::sqrt(covariance[i][i]); }

std::optional<ZeroPoint> fit_zero_point(std::span<const PhotometricStar> stars,
                                        double believed_extinction) {
  if (stars.empty()) return std::nullopt;
  ZeroPoint z{.extinction_mag_per_airmass = believed_extinction};
  z.colour_fitted = stars.size() >= 10 && spread(stars, &PhotometricStar::bv) > 0.3;
  z.extinction_fitted = stars.size() >= 20 && spread(stars, &PhotometricStar::airmass) > 0.25;
  std::vector<std::size_t> free{0};
  if (z.colour_fitted) free.push_back(1);
  if (z.extinction_fitted) free.push_back(2);
  const auto by = [](const PhotometricStar& s) {
    return std::array{1.0, s.bv - ZeroPoint::sunlike_bv, -s.airmass};
  };
  const auto residual = [&](const PhotometricStar& s) {
    const auto d = by(s);
    return s.v_mag - s.instrumental_mag - z.zero_point_mag * d[0] - z.colour_term * d[1] -
           z.extinction_mag_per_airmass * d[2];
  };
  std::vector<double> sizes, r(stars.size());
  for (std::size_t i = 0; i < stars.size(); ++i) r[i] = residual(stars[i]);
  z.zero_point_mag = median_of(r);
  const std::size_t n = free.size();
  for (int pass = 0; pass < 30; ++pass) {
    sizes.clear();
    for (std::size_t i = 0; i < stars.size(); ++i) {
      r[i] = residual(stars[i]);
      sizes.push_back(std::abs(r[i]));
    }
    const double scatter = std::max(least_scatter_mag, 1.4826 * median_of(sizes));
    std::vector<double> normal(n * n, 0.0), right(n, 0.0);
    double sum2 = 0.0;
    z.stars = 0;
    for (std::size_t i = 0; i < stars.size(); ++i) {
      // Variability and the band's shape scatter bright stars, photons the faint ones.
      const double variance = std::max(scatter * scatter, stars[i].sigma_mag * stars[i].sigma_mag);
      const double u2 = r[i] * r[i] / (variance * tukey * tukey);
      if (u2 >= 1) continue;
      const double w = (1 - u2) * (1 - u2) / variance;
      const auto d = by(stars[i]);
      ++z.stars;
      sum2 += r[i] * r[i];
      for (std::size_t a = 0; a < n; ++a) {
        right[a] += w * d[free[a]] * r[i];
        for (std::size_t b = 0; b < n; ++b) normal[a * n + b] += w * d[free[a]] * d[free[b]];
      }
    }
    if (z.stars < int(n) || !invert_positive(normal, int(n))) return std::nullopt;
    std::array<double, 3> step{};
    for (std::size_t a = 0; a < n; ++a)
      for (std::size_t b = 0; b < n; ++b) {
        step[free[a]] += normal[a * n + b] * right[b];
        z.covariance[free[a]][free[b]] = normal[a * n + b];
      }
    z.zero_point_mag += step[0];
    z.colour_term += step[1];
    z.extinction_mag_per_airmass += step[2];
    z.rms_mag = std::sqrt(sum2 / z.stars);
    if (std::abs(step[0]) + std::abs(step[1]) + std::abs(step[2]) < 1e-7) break;
  }
  return z;
}

}  // namespace dmise
