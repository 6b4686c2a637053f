#include "core/fusion/cued_sensor.h"

#include <algorithm>
#include <cmath>

#include "core/base/algebra/symmetric2.h"
#include "core/base/units.h"

namespace dmise {

SimTime CuedSensor::exposure_start(std::uint32_t number) const {
  return {sim_seconds(first_exposure_s).ns + std::int64_t(number - 1) * sim_seconds(cadence_s).ns};
}

std::uint32_t CuedSensor::first_frame_from(SimTime t) const {
  const std::int64_t after = t.ns - sim_seconds(first_exposure_s).ns;
  const std::int64_t every = sim_seconds(cadence_s).ns;
  return after <= 0 ? 1 : std::uint32_t((after + every - 1) / every + 1);
}

double probability_in_circle(const Eigen::Matrix2d& covariance, double radius) {
  // The eigenvalues are variances along the axes of the ellipse.
  const Symmetric2 ellipse{covariance(0, 0), covariance(1, 0), covariance(1, 1)};
  const double mean = mean_of_axes(ellipse), half_apart = half_of_axes(ellipse);
  const double shorter = std::sqrt(std::max(0.0, mean - half_apart));
  const double longer = std::sqrt(std::max(0.0, mean + half_apart));
  if (!(longer > 1e-9 * radius)) return 1.0;
  constexpr int steps = 256;  // Simpson's rule over the angle of the chord: smooth at the edge
  constexpr double root2 = 1.4142135623730951;
  const double reach = std::min(radius, 9 * longer), from = -std::asin(reach / radius);
  const double h = -2 * from / steps;
  double sum = 0;
  for (int i = 0; i <= steps; ++i) {
    const double angle = from + i * h, x = radius * std::sin(angle),
                 half = radius * std::cos(angle);
    const double z = x / longer;
    const double across = shorter > 1e-12 * radius ? std::erf(half / (root2 * shorter)) : 1.0;
    const double value = std::exp(-0.5 * z * z) / (longer * std::sqrt(2 * pi)) * across * half;
    sum += value * (i == 0 || i == steps ? 1 : i % 2 ? 4 : 2);
  }
  return std::clamp(sum * h / 3, 0.0, 1.0);
}

}  // namespace dmise
