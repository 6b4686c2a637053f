#include "core/detection/known/refraction_parallax.h"

#include <algorithm>
#include <cmath>

#include "core/detection/known/atmosphere.h"

namespace dmise {
namespace {

constexpr double earth_radius_m = 6371e3;
constexpr double min_range_m = 100e3;  // keeps ranges finite for high sites

double range_m(double from_centre_m, double sine_of_elevation, double altitude_m) {
  const double along = from_centre_m * sine_of_elevation, radius_m = earth_radius_m + altitude_m;
  const double square = along * along - from_centre_m * from_centre_m + radius_m * radius_m;
  return std::max(std::sqrt(std::max(square, 0.0)) - along, min_range_m);
}

}  // namespace

RefractionParallax refraction_parallax(const FrameHeader& header, const Vec<Gcrs>& direction) {
  const auto refraction = refraction_of(header);
  if (!refraction) return {};
  const Vec<Gcrs> zenith = zenith_of(header);
  const double sine = std::clamp(dot(direction, zenith), -1.0, 1.0);
  const Vec<Gcrs> up = zenith - direction * sine;
  if (!(norm(up) > 1e-9)) return {};
  RefractionParallax p;
  p.upwards = unit(up);
  const double aside_m = refraction->aside_m(refraction->apparent_from_true_rad(std::asin(sine)));
  p.offset_m = p.upwards * aside_m;

  constexpr int steps = 64;  // in the logarithm of altitude: moments to 1e-4
  double mean = 0.0, square = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double altitude_m =
        lowest_altitude_m * std::pow(highest_altitude_m / lowest_altitude_m, (i + 0.5) / steps);
    const double angle_rad = aside_m / range_m(norm(header.sensor_position_m), sine, altitude_m);
    mean += angle_rad / steps;
    square += angle_rad * angle_rad / steps;
  }
  p.mean_rad = mean;
  p.sigma_rad = std::sqrt(std::max(square - mean * mean, 0.0));
  return p;
}

}  // namespace dmise
