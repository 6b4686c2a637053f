#include "core/astrometry/zero_point.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "core/base/algebra/positive_matrix.h"
#include "core/base/algebra/two_unknowns.h"
#include "core/base/numeric/quantile.h"

namespace dmise {
namespace {

constexpr double tukey = 4.685;  // 95 % efficient for normal errors
constexpr double min_scatter_mag = 0.002;
// Stars determine extinction no better than this: it is not fitted; the first if it is believed,
// unless the fit contradicts what is believed.
constexpr double max_sigma_believed_mag = 0.005, max_sigma_mag = 0.05;
constexpr double contradicting_sigmas = 4.0;
/// Mean of the magnitude over the variance of a log-normal light whose mean is right.
constexpr double dimming_per_mag2 = 0.2 * 2.302585092994046;

double spread(std::span<const PhotometricStar> stars, double PhotometricStar::*value) {
  std::vector<double> values;
  for (const PhotometricStar& s : stars) values.push_back(s.*value);
  return quantile_of(values, 0.95) - quantile_of(values, 0.05);
}

double cube(double x) { return x * x * x; }

/// Variance of stars about the fit besides their photons': the same for all, of the band and of
/// variables, and a part by scintillation, which goes as the third power of the airmass (Young
/// 1967, AJ 72, 747).
struct Scatter {
  double even_mag2 = 0.0, scintillation_mag2 = 0.0;  // the second at an airmass of 1

  double of_air(const PhotometricStar& s) const { return scintillation_mag2 * cube(s.airmass); }
  double variance(const PhotometricStar& s) const {
    return even_mag2 + of_air(s) + s.sigma_mag * s.sigma_mag;
  }
};

/// Median squares of the residuals of groups of stars alike in airmass, as far as photons do not
/// explain them; one group unless `by_airmass`.
Scatter scatter_of(std::span<const PhotometricStar> stars, std::span<const double> residuals,
                   std::size_t free, bool by_airmass) {
  constexpr std::size_t min_group = 30, max_groups = 12;
  const std::size_t n = stars.size();
  const std::size_t groups = by_airmass ? std::clamp<std::size_t>(n / min_group, 1, max_groups) : 1;
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t(0));
  if (groups > 1)
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return stars[i].airmass; });
  const double lost = n > free ? std::sqrt(double(n) / double(n - free)) : 1.0;
  TwoSums sums{};
  for (std::size_t g = 0; g < groups; ++g) {
    std::vector<double> sizes, photons, cubes;
    for (std::size_t at = g * n / groups; at < (g + 1) * n / groups; ++at) {
      const PhotometricStar& s = stars[order[at]];
      sizes.push_back(std::abs(residuals[order[at]]));
      photons.push_back(s.sigma_mag * s.sigma_mag);
      cubes.push_back(cube(s.airmass));
    }
    const double size = lost * sigma_of_median * median_of(sizes), all = size * size;
    const double v = all - median_of(photons), x = median_of(cubes);
    const double weight = 1.0 / std::max(all * all, 1e-16);
    add_row(1.0, x, v, weight, sums);
  }
  constexpr double least = min_scatter_mag * min_scatter_mag;
  const auto& [w, wx, wxx, wv, wxv] = sums;
  Scatter s{.even_mag2 = std::max(wv / w, least)};
  if (groups < 2 || !(determinant(matrix_of(sums)) > 1e-9 * w * wxx)) return s;
  s.scintillation_mag2 = std::max(0.0, solution_of(sums)[1]);
  s.even_mag2 = (wv - s.scintillation_mag2 * wx) / w;
  if (s.even_mag2 < least) {
    s.even_mag2 = least;
    s.scintillation_mag2 = std::max(0.0, (wxv - least * wx) / wxx);
  }
  return s;
}

std::optional<ZeroPoint> fit(std::span<const PhotometricStar> stars, ZeroPoint z, bool by_airmass) {
  std::vector<std::size_t> free{0};
  if (z.colour_fitted) free.push_back(1);
  if (z.extinction_fitted) free.push_back(2);
  const auto by = [](const PhotometricStar& s) {
    return std::array{1.0, s.bv - ZeroPoint::sunlike_bv, -s.airmass};
  };
  const std::size_t n = free.size();
  Scatter scatter;
  std::vector<double> r(stars.size());
  const auto measure_residuals = [&] {
    for (std::size_t i = 0; i < stars.size(); ++i) {
      const PhotometricStar& s = stars[i];
      const auto d = by(s);
      // The mean of scintillating light is right, that of its magnitudes is too faint.
      const double instrumental = s.instrumental_mag - dimming_per_mag2 * scatter.of_air(s);
      r[i] = s.v_mag - instrumental - z.zero_point_mag * d[0] - z.colour_term * d[1] -
             z.extinction_mag_per_airmass * d[2];
    }
  };
  measure_residuals();
  z.zero_point_mag = median_of(r);
  for (int pass = 0; pass < 50; ++pass) {
    measure_residuals();
    if (pass < 30) scatter = scatter_of(stars, r, n, by_airmass);
    std::vector<double> normal(n * n, 0.0), weighted(n * n, 0.0), right(n, 0.0);
    double sum2 = 0.0, psi2 = 0.0, slope = 0.0;
    z.stars = 0;
    for (std::size_t i = 0; i < stars.size(); ++i) {
      const double variance = scatter.variance(stars[i]);
      const double u2 = r[i] * r[i] / (variance * tukey * tukey);
      const auto d = by(stars[i]);
      const double w = u2 < 1 ? (1 - u2) * (1 - u2) / variance : 0.0;
      for (std::size_t a = 0; a < n; ++a) {
        right[a] += w * d[free[a]] * r[i];
        for (std::size_t b = 0; b < n; ++b) {
          normal[a * n + b] += d[free[a]] * d[free[b]] / variance;
          weighted[a * n + b] += w * d[free[a]] * d[free[b]];
        }
      }
      if (u2 >= 1) continue;
      ++z.stars;
      sum2 += r[i] * r[i];
      psi2 += w * w * variance * r[i] * r[i];
      slope += (1 - u2) * (1 - 5 * u2);
    }
    if (z.stars < int(n) || !invert_positive(weighted, int(n)) || !invert_positive(normal, int(n)))
      return std::nullopt;
    // An M-estimator's scale (Huber 1981, Robust Statistics, section 7.6), never less than stated.
    const double count = double(stars.size());
    const double scale =
        count > double(n) && slope > 0
            ? std::max(1.0, psi2 / (count - double(n)) * std::pow(count / slope, 2))
            : 1.0;
    std::array<double, 3> step{};
    for (std::size_t a = 0; a < n; ++a)
      for (std::size_t b = 0; b < n; ++b) {
        step[free[a]] += weighted[a * n + b] * right[b];
        z.covariance[free[a]][free[b]] = scale * normal[a * n + b];
      }
    z.zero_point_mag += step[0];
    z.colour_term += step[1];
    z.extinction_mag_per_airmass += step[2];
    z.rms_mag = std::sqrt(sum2 / z.stars);
    if (std::abs(step[0]) + std::abs(step[1]) + std::abs(step[2]) < 1e-6) break;
  }
  z.even_mag2 = scatter.even_mag2;
  z.scintillation_mag2 = scatter.scintillation_mag2;
  return z;
}

}  // namespace

double ZeroPoint::scatter_mag(double airmass) const {
  return std::sqrt(even_mag2 + scintillation_mag2 * cube(airmass));
}

double ZeroPoint::sigma(std::size_t i) const { return std::sqrt(covariance[i][i]); }

std::optional<ZeroPoint> fit_zero_point(std::span<const PhotometricStar> stars,
                                        std::optional<double> believed_extinction) {
  if (stars.empty()) return std::nullopt;
  ZeroPoint start{.extinction_mag_per_airmass = believed_extinction.value_or(0.0)};
  start.colour_fitted = stars.size() >= 10 && spread(stars, &PhotometricStar::bv) > 0.3;
  const bool by_airmass = stars.size() >= 20 && spread(stars, &PhotometricStar::airmass) > 0.25;
  start.extinction_fitted = by_airmass;
  const auto z = fit(stars, start, by_airmass);
  if (!start.extinction_fitted) return z;
  if (z && z->sigma(2) < max_sigma_mag) {
    if (!believed_extinction || z->sigma(2) < max_sigma_believed_mag) return z;
    const double off = z->extinction_mag_per_airmass - *believed_extinction;
    if (std::abs(off) > contradicting_sigmas * z->sigma(2)) return z;
  }
  start.extinction_fitted = false;
  return fit(stars, start, by_airmass);
}

}  // namespace dmise
