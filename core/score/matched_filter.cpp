#include "core/score/matched_filter.h"

#include <cmath>

#include "core/base/units.h"

namespace dmise {
namespace {

double blurred_sigma_px(const IdealSource& s) {
  return std::sqrt(s.sigma_px * s.sigma_px + 1.0 / 12.0);
}

/// Length of the uniform line without ends that has the trail's integral of the squared template;
/// 2 sqrt(pi) sigma for a point.
double effective_length_px(const IdealSource& s) {
  const double sigma = blurred_sigma_px(s), ratio = s.length_px / (2.0 * sigma);
  if (ratio < 1e-3) return 2.0 * sigma * std::sqrt(pi);
  return s.length_px / (std::erf(ratio) + std::expm1(-ratio * ratio) / (ratio * std::sqrt(pi)));
}

}  // namespace

double matched_filter_snr(const IdealSource& s) {
  return s.signal_e / s.noise_e /
         std::sqrt(2.0 * std::sqrt(pi) * blurred_sigma_px(s) * effective_length_px(s));
}

double position_bound_px(const IdealSource& s) {
  const double sigma = blurred_sigma_px(s), length = effective_length_px(s);
  const double peak_e = s.signal_e / length / (sigma * std::sqrt(2.0 * pi));
  constexpr int steps = 1000;
  const double step = 8.0 * sigma / steps;
  double information = 0.0;
  for (int k = 0; k < steps; ++k) {
    const double y = (k + 0.5) * step;
    const double light_e = peak_e * std::exp(-0.5 * y * y / (sigma * sigma));
    const double slope = light_e * y / (sigma * sigma);
    information += 2.0 * length * step * slope * slope / (s.noise_e * s.noise_e + light_e);
  }
  return 1.0 / std::sqrt(information);
}

double theory_of_detection(double snr, double threshold_snr) {
  return 0.5 * std::erfc((threshold_snr - snr) / std::sqrt(2.0));
}

}  // namespace dmise
