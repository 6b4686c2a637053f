#include "core/camera_calibration/star_zero_point.h"

#include <algorithm>
#include <cmath>

#include "core/astrometry/zero_point.h"
#include "core/base/algebra/two_unknowns.h"
#include "core/base/numeric/quantile.h"
#include "core/camera_calibration/frame_scatter.h"

namespace dmise {
namespace {

constexpr std::size_t light_parts = 32, min_light_stars = 5, min_coloured_stars = 10;

/// A star beside a line: what it is off, and its deviation as a star of the line's light has it.
/// One that noise has made bright claims less noise, and would weigh more than one made faint.
struct OffLine {
  double off = 0.0, noise = 0.0, weight = 0.0;

  OffLine(const StarZeroPoint& star, const std::array<double, 2>& line)
      : off(star.mag - line[0] - line[1] * (star.bv - ZeroPoint::sunlike_bv)),
        noise(star.sigma_mag * std::pow(10.0, 0.4 * std::clamp(off, -1.0, 1.0))) {}
};

double scatter_of(const std::vector<OffLine>& stars) {
  constexpr double min_mag = 1e-3, max_mag = 0.3;
  return scatter_beside(
      stars, [](const OffLine& s) { return s.off; },
      [](const OffLine& s) { return s.noise * s.noise; }, min_mag * min_mag, max_mag * max_mag);
}

/// Weights by noise and scatter; 0 of outliers, and of faint stars if there are enough others.
void weigh(std::vector<OffLine>& stars, double scatter2) {
  constexpr double light_outlier_sigmas = 4.0, max_noise_mag = 0.03;
  for (const double max_mag : {max_noise_mag, HUGE_VAL}) {
    std::size_t kept = 0;
    for (OffLine& s : stars) {
      const double variance = s.noise * s.noise + scatter2;
      const bool use =
          s.noise < max_mag && std::abs(s.off) < light_outlier_sigmas * std::sqrt(variance);
      s.weight = use ? 1 / variance : 0.0;
      kept += use;
    }
    if (kept >= min_coloured_stars) return;
  }
}

/// The sums by which zero point and colour term are fitted.
TwoSums sums_of(const StarZeroPoint& star, double weight) {
  return row_of(1.0, star.bv - ZeroPoint::sunlike_bv, star.mag, weight);
}

/// The median of the stars by weight.
double weighted_median_of(std::span<const StarZeroPoint> stars) {
  std::vector<std::pair<double, double>> values;
  double total = 0.0, below = 0.0;
  for (const StarZeroPoint& star : stars) {
    values.emplace_back(star.mag, 1 / (star.sigma_mag * star.sigma_mag));
    total += values.back().second;
  }
  std::ranges::sort(values);
  for (const auto& [mag, weight] : values) {
    below += weight;
    if (below >= 0.5 * total) return mag;
  }
  return values.back().first;
}

/// A zero point by lines through the stars, each weighed by the line before.
class LightFit {
 public:
  explicit LightFit(std::span<const StarZeroPoint> stars) : stars_(stars) {
    constexpr double min_colours = 0.3;
    std::vector<double> colours;
    for (const StarZeroPoint& star : stars) colours.push_back(star.bv);
    coloured_ = stars.size() >= min_coloured_stars &&
                quantile_of(colours, 0.9) - quantile_of(colours, 0.1) > min_colours;
    line_[0] = weighted_median_of(stars);
    for (int round = 0; round < 8; ++round) {
      beside_.clear();
      for (const StarZeroPoint& star : stars) beside_.emplace_back(star, line_);
      weigh(beside_, scatter_of(beside_));
      TwoSums all{};
      for (std::size_t k = 0; k < stars.size(); ++k) {
        const TwoSums row = sums_of(stars[k], beside_[k].weight);
        for (std::size_t i = 0; i < row.size(); ++i) all[i] += row[i];
      }
      line_ = solution_of(all, coloured_);
    }
  }

  /// Deviations are by the stars' scatter, and by leaving out parts, as a few bright stars may hold
  /// most of the weight; the greater holds.
  MeasuredValue zero_point() const {
    std::vector<TwoSums> parts(light_parts);
    std::size_t used = 0;
    TwoSums all{};
    double chi2 = 0.0;
    for (std::size_t k = 0; k < stars_.size(); ++k) {
      if (!(beside_[k].weight > 0)) continue;
      const TwoSums row = sums_of(stars_[k], beside_[k].weight);
      TwoSums& part = parts[used++ % light_parts];
      for (std::size_t i = 0; i < row.size(); ++i) part[i] += row[i], all[i] += row[i];
      chi2 += beside_[k].weight * std::pow(OffLine(stars_[k], line_).off, 2);
    }
    parts.resize(std::min(used, light_parts));
    MeasuredValue out =
        jackknifed(parts, [&](const TwoSums& s) { return solution_of(s, coloured_)[0]; });
    const double degrees = double(used) - (coloured_ ? 2.0 : 1.0);
    const double variance = coloured_ ? all[2] / determinant(matrix_of(all)) : 1 / all[0];
    out.sigma = std::max(out.sigma, std::sqrt(variance * std::max(1.0, chi2 / degrees)));
    return out;
  }
  std::vector<FrameResidual> residuals() const {
    std::vector<FrameResidual> out;
    for (std::size_t k = 0; k < stars_.size(); ++k)
      if (beside_[k].weight > 0)
        out.push_back({stars_[k].frame, OffLine(stars_[k], line_).off, 1 / beside_[k].weight});
    return out;
  }
  bool has_stars() const {
    return std::ranges::count_if(beside_, [](const OffLine& s) { return s.weight > 0; }) >=
           std::ptrdiff_t(min_light_stars);
  }

 private:
  std::span<const StarZeroPoint> stars_;
  bool coloured_ = false;
  std::array<double, 2> line_{};
  std::vector<OffLine> beside_;
};

}  // namespace

std::optional<MeasuredValue> joint_zero_point(std::span<const StarZeroPoint> stars) {
  if (stars.size() < min_light_stars) return std::nullopt;
  const LightFit fit(stars);
  if (!fit.has_stars()) return std::nullopt;
  MeasuredValue out = fit.zero_point();
  out.sigma = std::hypot(out.sigma, deviation_by_frames(fit.residuals()));
  return out;
}

}  // namespace dmise
