#include "core/base/numeric/monotone_cubic.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/error.h"

namespace dmise {
namespace {

bool same_sign(double a, double b) { return (a > 0.0 && b > 0.0) || (a < 0.0 && b < 0.0); }

/// The slope at an end, by three points, so that the curve is monotone there; `near` and `next` are
/// the first two intervals, `rise` the slopes of their chords.
double end_slope(double near, double next, double near_rise, double next_rise) {
  const double slope = ((2 * near + next) * near_rise - near * next_rise) / (near + next);
  if (!same_sign(slope, near_rise)) return 0.0;
  if (!same_sign(near_rise, next_rise) && std::abs(slope) > 3 * std::abs(near_rise))
    return 3 * near_rise;
  return slope;
}

}  // namespace

MonotoneCubic::MonotoneCubic(std::vector<double> at, std::vector<double> value)
    : at_(std::move(at)), value_(std::move(value)), slope_(at_.size()) {
  const std::size_t n = at_.size();
  if (value_.size() != n) throw Error("curve: as many values as places are needed");
  for (std::size_t i = 0; i < n; ++i) {
    if (!std::isfinite(at_[i]) || !std::isfinite(value_[i])) throw Error("curve: not finite");
    if (i > 0 && !(at_[i] > at_[i - 1])) throw Error("curve: places must rise");
  }
  if (n < 2) return;
  std::vector<double> step(n - 1), rise(n - 1);
  for (std::size_t i = 0; i + 1 < n; ++i) {
    step[i] = at_[i + 1] - at_[i];
    rise[i] = (value_[i + 1] - value_[i]) / step[i];
  }
  if (n == 2) {
    slope_[0] = slope_[1] = rise[0];
    return;
  }
  for (std::size_t i = 1; i + 1 < n; ++i) {
    if (!same_sign(rise[i - 1], rise[i])) continue;
    const double before = 2 * step[i] + step[i - 1], after = step[i] + 2 * step[i - 1];
    slope_[i] = (before + after) / (before / rise[i - 1] + after / rise[i]);
  }
  slope_[0] = end_slope(step[0], step[1], rise[0], rise[1]);
  slope_[n - 1] = end_slope(step[n - 2], step[n - 3], rise[n - 2], rise[n - 3]);
}

double MonotoneCubic::operator()(double x) const {
  if (at_.empty()) return 0.0;
  if (!(x > at_.front())) return value_.front();
  if (!(x < at_.back())) return value_.back();
  const auto i = std::size_t(std::upper_bound(at_.begin(), at_.end(), x) - at_.begin() - 1);
  const double h = at_[i + 1] - at_[i], t = (x - at_[i]) / h, s = 1.0 - t;
  return value_[i] * (1 + 2 * t) * s * s + value_[i + 1] * (1 + 2 * s) * t * t +
         h * s * t * (s * slope_[i] - t * slope_[i + 1]);
}

}  // namespace dmise
