#include "core/detection/streaks/neglected_errors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/base/units.h"

namespace dmise {
namespace {

constexpr double model_px = 0.001;
constexpr double uneven = 0.007;     // change of brightness of a streak that is fitted as even
constexpr double next_order = 10.0;  // over SNR^2

/// How an error of a fitted parameter follows from those of what the ends determine.
using ByEnds = std::array<double, end_parameters>;

/// How each parameter of a fit follows from the ends, the background last.
std::vector<ByEnds> by_ends(const Source& source) {
  const double c = std::cos(source.trail().angle_rad), s = std::sin(source.trail().angle_rad);
  std::vector<ByEnds> out;
  for (unsigned bit = 0; bit < trail_parameters; ++bit) {
    const unsigned parameter = 1u << bit;
    if (!(source.free & parameter)) continue;
    ByEnds& by = out.emplace_back(ByEnds{});
    if (parameter == trail_x) by[end_middle] = c, by[end_beside] = -s;
    if (parameter == trail_y) by[end_middle] = s, by[end_beside] = c;
    if (parameter == trail_flux) by[end_flux] = 1.0;
    if (parameter == trail_length) by[end_length] = 1.0;
    if (parameter == trail_slope) by[end_slope] = 1.0;
  }
  out.resize(std::size_t(source.fit.parameters), ByEnds{});
  return out;
}

/// Puts `ends` in the place of all errors that are along the line, and adds those beside it.
void replace_along(Source& source, const EndErrors& ends) {
  const auto n = std::size_t(source.fit.parameters);
  const std::vector<ByEnds> by = by_ends(source);
  std::vector<double>& covariance = source.fit.covariance;
  // What is left of an error without its part along the line: rows are orthogonal to `by`.
  std::vector<double> left(n * n, 0.0), half(n * n, 0.0);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) {
      left[i * n + j] = i == j ? 1.0 : 0.0;
      for (std::size_t e = 0; e < end_beside; ++e) left[i * n + j] -= by[i][e] * by[j][e];
    }
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t k = 0; k < n; ++k)
        half[i * n + j] += left[i * n + k] * covariance[k * n + j];
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) {
      double sum = 0.0;
      for (std::size_t k = 0; k < n; ++k) sum += half[i * n + k] * left[j * n + k];
      for (std::size_t e = 0; e < end_parameters; ++e)
        for (std::size_t f = 0; f < end_parameters; ++f) sum += by[i][e] * ends[e][f] * by[j][f];
      covariance[i * n + j] = sum;
    }
}

}  // namespace

double end_error_px(double snr2_per_px) { return std::sqrt(26.0) / snr2_per_px; }

void add_neglected_errors(Source& source, const EndErrors* ends) {
  const Trail& t = source.trail();
  if (source.streak) {
    const auto n = std::size_t(source.fit.parameters);
    const double faint = std::sqrt(1 + next_order / (source.snr() * source.snr()));
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j)
        source.fit.covariance[i * n + j] *= (i == 2 ? 1.0 : faint) * (j == 2 ? 1.0 : faint);
    if (ends) replace_along(source, *ends);
  }
  const double uneven_px =
      source.streak && !(source.free & trail_slope) ? uneven * t.length_px / 6 : 0.0;
  const double along_px2 = uneven_px * uneven_px;
  const double c = std::cos(t.angle_rad), s = std::sin(t.angle_rad);
  source.fit.add_cov(0, 0, model_px * model_px + along_px2 * c * c);
  source.fit.add_cov(0, 1, along_px2 * c * s);
  source.fit.add_cov(1, 1, model_px * model_px + along_px2 * s * s);
}

void add_steps_at_ends(Source& source, double sigma_px) {
  const Trail& t = source.trail();
  const double length_px = std::max(t.length_px, 1.0);
  const double snr2_per_px = source.snr() * source.snr() / length_px;
  if (!source.streak || !(source.free & trail_length) || !(snr2_per_px > 0)) return;
  const double end_px = end_error_px(snr2_per_px);
  const double end_px2 = std::min(end_px * end_px * std::exp(-0.5 * snr2_per_px * sigma_px),
                                  t.length_px * t.length_px / 12);
  source.fit.add_cov(2, 2, 2 * end_px2 * std::pow(t.flux_e / length_px, 2));
}

void add_column_noise(Source& source, double column_noise_e, double sigma_px) {
  constexpr double max_across_px = 3.0;  // columns that its middle passes
  const Trail& t = source.trail();
  const double across_px = std::abs(t.length_px * std::cos(t.angle_rad));
  if (!source.streak || !(column_noise_e > 0) || across_px > max_across_px) return;
  // The profile across covers as many columns as the matched filter sums.
  const double columns = 2 * sigma_px * std::sqrt(pi);
  const double share = columns / (columns + across_px);
  source.fit.add_cov(2, 2, columns * share * std::pow(column_noise_e * t.length_px, 2));
}

}  // namespace dmise
