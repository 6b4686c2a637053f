#include "core/sky/refraction.h"

#include <erfa.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/error.h"
#include "core/base/units.h"

namespace dmise {
namespace {

constexpr double series_ends_rad = 15 * deg;   // elevation: the series alone above
constexpr double bennett_ends_rad = 10 * deg;  // Bennett alone below

void check(double value, double low, double high, const char* name) {
  if (!(value >= low && value <= high))
    throw Error(std::string(name) + ": must be in [" + std::to_string(low) + ", " +
                std::to_string(high) + "], got " + std::to_string(value));
}

}  // namespace

// ISO 2533: 6.5 K/km to 11 km.
Weather standard_weather(double height_m) {
  const double h = std::min(height_m, 11000.0);
  const double temperature_k = 288.15 - 0.0065 * h;
  double pressure = 1013.25 * std::pow(temperature_k / 288.15, 5.255876);
  if (height_m > 11000.0) pressure *= std::exp(-(height_m - 11000.0) / 6341.62);
  return {.pressure_hpa = pressure, .temperature_c = temperature_k - 273.15};
}

Refraction::Refraction(const Weather& weather, double wavelength_um) {
  check(weather.pressure_hpa, 0.0, 10000.0, "pressure_hpa");
  check(weather.temperature_c, -150.0, 200.0, "temperature_c");
  check(weather.humidity, 0.0, 1.0, "humidity");
  check(wavelength_um, 0.1, 100.0, "wavelength_um");
  eraRefco(weather.pressure_hpa, weather.temperature_c, weather.humidity, wavelength_um,
           &tan_term_rad_, &tan3_term_rad_);
  if (!(tan_term_rad_ > 0.0)) {
    tan_term_rad_ = tan3_term_rad_ = 0.0;
    return;
  }
  bennett_scale_ = 1.0;
  bennett_scale_ = series_rad(series_ends_rad) / bennett_rad(series_ends_rad);

  // The two terms are g (1 - h) and -g (h - g/2) with g the refractivity and h the scale height.
  const double difference = tan_term_rad_ - tan3_term_rad_;  // g - g^2/2
  refractivity_ = 1.0 - std::sqrt(1.0 - 2.0 * difference);
  scale_height_ = 1.0 - tan_term_rad_ / refractivity_;
  // At the horizon the incoming line passes n - cos R radii from the Earth's centre.
  const double horizon = at_apparent_rad(0.0);
  horizon_flattening_ = refractivity_ * scale_height_ / (refractivity_ + 1.0 - std::cos(horizon));
}

double Refraction::series_rad(double apparent_elevation_rad) const {
  const double tan_z = std::tan(0.5 * pi - apparent_elevation_rad);
  return tan_z * (tan_term_rad_ + tan3_term_rad_ * tan_z * tan_z);
}

// Bennett 1982, Journal of Navigation 35, 255.
double Refraction::bennett_rad(double apparent_elevation_rad) const {
  const double h_deg = apparent_elevation_rad / deg;
  return bennett_scale_ * arcmin / std::tan((h_deg + 7.31 / (h_deg + 4.4)) * deg);
}

double Refraction::at_apparent_rad(double apparent_elevation_rad) const {
  if (bennett_scale_ == 0.0) return 0.0;
  const double h = std::clamp(apparent_elevation_rad, 0.0, 0.5 * pi);
  if (h >= series_ends_rad) return series_rad(h);
  if (h <= bennett_ends_rad) return bennett_rad(h);
  const double x = (h - bennett_ends_rad) / (series_ends_rad - bennett_ends_rad);
  const double weight = x * x * (3 - 2 * x);
  return weight * series_rad(h) + (1 - weight) * bennett_rad(h);
}

// How far aside of the observer the incoming line passes, in radii. In second order g h sin z/cos^2
// z, which also follows from the series; made finite so that it meets the exact value at the
// horizon.
double Refraction::offset_per_radius(double apparent_elevation_rad) const {
  const double h = std::clamp(apparent_elevation_rad, 0.0, 0.5 * pi);
  const double sin_h = std::sin(h);
  return refractivity_ * scale_height_ * std::cos(h) / (sin_h * sin_h + horizon_flattening_);
}

double Refraction::of_body_rad(double apparent_elevation_rad, double radius_per_distance) const {
  const double of_star = at_apparent_rad(apparent_elevation_rad);
  if (radius_per_distance == 0.0 || of_star == 0.0) return of_star;
  const double aside = offset_per_radius(apparent_elevation_rad) * radius_per_distance;
  return of_star - std::asin(std::min(aside, std::sin(of_star)));
}

// Solves apparent - R(apparent) = true by secants; R falls by less than 0.25 per unit, so that
// plain repetition starts well inside.
double Refraction::lifted(double true_elevation_rad, double radius_per_distance) const {
  double a = true_elevation_rad + of_body_rad(true_elevation_rad, radius_per_distance);
  double next = true_elevation_rad + of_body_rad(a, radius_per_distance);
  double error_a = a - next;
  double b = next;
  for (int i = 0; i < 30; ++i) {
    const double error_b = b - true_elevation_rad - of_body_rad(b, radius_per_distance);
    if (std::abs(error_b) < 1e-14 || error_b == error_a) break;
    next = b - error_b * (b - a) / (error_b - error_a);
    a = b;
    error_a = error_b;
    b = next;
  }
  return b;
}

double Refraction::apparent_from_true_rad(double true_elevation_rad) const {
  return bennett_scale_ == 0.0 ? true_elevation_rad : lifted(true_elevation_rad, 0.0);
}

double Refraction::true_from_apparent_rad(double apparent_elevation_rad) const {
  return apparent_elevation_rad - at_apparent_rad(apparent_elevation_rad);
}

double Refraction::apparent_from_true_rad(double true_elevation_rad, double distance_m,
                                          double observer_radius_m) const {
  if (bennett_scale_ == 0.0) return true_elevation_rad;
  return lifted(true_elevation_rad, observer_radius_m / distance_m);
}

double Refraction::true_from_apparent_rad(double apparent_elevation_rad, double distance_m,
                                          double observer_radius_m) const {
  return apparent_elevation_rad -
         of_body_rad(apparent_elevation_rad, observer_radius_m / distance_m);
}

}  // namespace dmise
