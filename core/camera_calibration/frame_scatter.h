#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "core/base/numeric/chi_square.h"
#include "core/base/numeric/quantile.h"

namespace dmise {

/// Variance beside their own with which half the values are as far off as half of a normal
/// distribution, at least `least` and at most `most`; all count alike, however exact.
template <class Stars, class Off, class Variance>
double scatter_beside(const Stars& stars, Off&& off_of, Variance&& variance_of, double least,
                      double most) {
  constexpr double median_of_square = 0.4549;
  const auto is_enough = [&](double scatter2) {
    std::vector<double> squares;
    for (const auto& star : stars)
      squares.push_back(off_of(star) * off_of(star) / (variance_of(star) + scatter2));
    return median_of(std::move(squares)) <= median_of_square;
  };
  if (is_enough(least)) return least;
  for (int step = 0; step < 30; ++step) {
    const double middle = std::sqrt(least * most);
    (is_enough(middle) ? most : least) = middle;
  }
  return most;
}

/// What a star is off from a fit to the stars of all frames.
struct FrameResidual {
  std::size_t frame = 0;
  double off = 0.0, variance = 0.0;
};

/// Deviation of a mean over frames by what these have in common each and do not share, as seeing
/// that changes; 0 if their stars explain at 3.1 sigma how their means scatter.
inline double deviation_by_frames(std::span<const FrameResidual> residuals) {
  constexpr double shown_by_frames_sigmas = 3.1;
  std::vector<double> weights, sums;
  for (const FrameResidual& r : residuals) {
    if (r.frame >= weights.size()) weights.resize(r.frame + 1), sums.resize(r.frame + 1);
    weights[r.frame] += 1 / r.variance;
    sums[r.frame] += r.off / r.variance;
  }
  double chi2 = 0.0, squares = 0.0, n = 0.0;
  for (std::size_t f = 0; f < weights.size(); ++f) {
    if (!(weights[f] > 0)) continue;
    const double mean = sums[f] / weights[f];
    chi2 += mean * mean * weights[f];
    squares += mean * mean;
    ++n;
  }
  if (n < 2 || chi2 < chi_square_of_normal(shown_by_frames_sigmas, n - 1)) return 0.0;
  return std::sqrt(squares / (n - 1) / n);
}

}  // namespace dmise
