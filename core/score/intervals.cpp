#include "core/score/intervals.h"

#include <algorithm>
#include <cmath>

#include "core/base/numeric/chi_square.h"
#include "core/base/units.h"
#include "core/score/matched_filter.h"

namespace dmise {
namespace {

constexpr double z95 = 1.959963984540054;

/// P(chi-square of 2 `count` degrees of freedom <= x): one minus a sum of Poisson's probabilities.
double chi_square_share(double x, std::size_t count) {
  double above = 0.0;
  for (std::size_t k = 0; k < count; ++k)
    above += std::exp(double(k) * std::log(0.5 * x) - 0.5 * x - std::lgamma(double(k) + 1.0));
  return 1.0 - above;
}

/// Root of a rising function between two places.
template <class F>
double root(F&& f, double low, double high) {
  for (int k = 0; k < 100; ++k) {
    const double middle = 0.5 * (low + high);
    (f(middle) < 0.0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

Interval wilson_interval(std::size_t successes, std::size_t trials) {
  if (trials == 0) return {0.0, 1.0};
  const double n = double(trials), p = double(successes) / n, z2 = z95 * z95;
  const double centre = (p + z2 / (2 * n)) / (1 + z2 / n);
  const double half = z95 / (1 + z2 / n) * std::sqrt(p * (1 - p) / n + z2 / (4 * n * n));
  return {successes == 0 ? 0.0 : centre - half, successes == trials ? 1.0 : centre + half};
}

Interval nees_interval(std::size_t count) {
  const double degrees = 2.0 * double(count),
               far = degrees + 10.0 * std::sqrt(2.0 * degrees) + 20.0;
  const auto quantile = [&](double p, double z) {
    if (count > 2000) return chi_square_of_normal(z, degrees) / degrees;  // to 1e-6 there
    return root([&](double x) { return chi_square_share(x, count) - p; }, 1e-12, far) / degrees;
  };
  return {quantile(0.025, -z95), quantile(0.975, z95)};
}

std::optional<double> fitted_threshold(std::span<const DetectionTrial> trials) {
  const auto found = std::ranges::count_if(trials, &DetectionTrial::found);
  if (found == 0 || std::size_t(found) == trials.size()) return {};
  const auto [least, most] = std::ranges::minmax(trials, {}, &DetectionTrial::snr);
  // Minus the derivative of the log likelihood, which rises with the threshold.
  const auto slope = [&](double threshold) {
    double sum = 0.0;
    for (const DetectionTrial& trial : trials) {
      const double x = trial.snr - threshold, side = trial.found ? x : -x;
      const double ratio = side < -25.0 ? -side  // its limit
                                        : std::exp(-0.5 * x * x) / std::sqrt(2.0 * pi) /
                                              theory_of_detection(side, 0.0);
      sum += trial.found ? ratio : -ratio;
    }
    return sum;
  };
  return root(slope, least.snr - 30.0, most.snr + 30.0);
}

}  // namespace dmise
