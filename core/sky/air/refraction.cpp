#include "core/sky/air/refraction.h"

#include <erfa.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/error.h"
#include "core/base/units.h"

namespace dmise {
namespace {

// Refractivity of dry air: a + b s + c s^2 with s = 1 / um^2.
constexpr double dry_a = 77.53484, dry_b = 0.439108, dry_c = 0.003666;

constexpr double series_ends_rad = 15 * deg;   // elevation: the series alone above
constexpr double bennett_ends_rad = 10 * deg;  // Bennett alone below
// By how much rays traced through the standard atmosphere, its lapse rate from the observer's
// temperature to 216.65 K, are bent more than Bennett has it: two falling exponentials of the
// apparent elevation with factors by t = (temperature - 15 C) / 30 K and by p = pressure / 1013.25
// hPa - 1. Fitted by tests/reference/refraction.py to 0.15 % at 0 to 10 deg, -20 to 35 C, 620 to
// 1013 hPa.
struct Bend {
  double scale_rad, constant, t, tt, p, tp;
};
constexpr Bend bends[] = {{1.8 * deg, -0.0322, -0.0377, 0.0087, 0.0569, -0.0297},
                          {4.0 * deg, 0.0112, -0.0316, 0.0005, 0.0227, 0.0024}};

constexpr double earth_radius_m = 6371e3;
constexpr double gas_constant_per_gravity_m_per_k = 287.05287 / 9.80665;  // dry air, ISO 2533

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

double dry_air_refractivity(double wavelength_m) {
  const double s = 1e-12 / (wavelength_m * wavelength_m);
  return dry_a + s * (dry_b + s * dry_c);
}

double wavelength_of_dry_air_m(double refractivity) {
  const double q = dry_b * dry_b + 4.0 * dry_c * (refractivity - dry_a);
  return 1e-6 / std::sqrt((std::sqrt(q) - dry_b) / (2.0 * dry_c));
}

Refraction::Refraction(const Weather& weather, double wavelength_um)
    : weather_(weather), wavelength_um_(wavelength_um) {
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
  const double t = (std::clamp(weather.temperature_c, -20.0, 35.0) - 15.0) / 30.0;
  const double p = std::clamp(weather.pressure_hpa, 620.0, 1050.0) / 1013.25 - 1.0;
  for (std::size_t i = 0; i < bends_.size(); ++i) {
    const Bend& b = bends[i];
    bends_[i] = b.constant + t * (b.t + t * b.tt) + p * (b.p + t * b.tp);
  }
  bennett_scale_ = 1.0;
  bennett_scale_ = series_rad(series_ends_rad) / bennett_rad(series_ends_rad);

  // The two terms are g (1 - h) and -g (h - g/2) with g the refractivity, h the scale height.
  refractivity_ = 1.0 - std::sqrt(1.0 - 2.0 * (tan_term_rad_ - tan3_term_rad_));
  scale_height_m_ = gas_constant_per_gravity_m_per_k * (weather.temperature_c + 273.15);
  // The line of a ray that comes in level passes the Earth's centre at n radii, the observer's at
  // cos R.
  const double scale_height = scale_height_m_ / earth_radius_m;
  aside_at_horizon_ =
      refractivity_ * scale_height / (refractivity_ + 1.0 - std::cos(at_apparent_rad(0.0)));
  aside_above_ = 2.27 * scale_height;
}

double Refraction::series_rad(double apparent_elevation_rad) const {
  return series_of_tan_rad(std::tan(0.5 * pi - apparent_elevation_rad));
}

double Refraction::series_of_tan_rad(double tan_z) const {
  return tan_z * (tan_term_rad_ + tan3_term_rad_ * tan_z * tan_z);
}

// Bennett 1982, Journal of Navigation 35, 255, with his second term, brought to traced rays.
double Refraction::bennett_rad(double apparent_elevation_rad) const {
  const double h_deg = apparent_elevation_rad / deg;
  const double first = 1.0 / std::tan((h_deg + 7.31 / (h_deg + 4.4)) * deg);
  double more = 1.0;
  for (std::size_t i = 0; i < bends_.size(); ++i)
    more += bends_[i] * std::exp(-apparent_elevation_rad / bends[i].scale_rad);
  return bennett_scale_ * more * arcmin * (first - 0.06 * std::sin((14.7 * first + 13.0) * deg));
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

// How far aside of the observer the line of the incoming ray passes. In second order g H sin
// z/cos^2 z, which follows from the series too; the terms that keep it finite meet the exact value
// at the horizon and were fitted to rays traced through the standard atmosphere
// (tests/reference/refraction.py).
double Refraction::aside_m(double apparent_elevation_rad) const {
  const double h = std::clamp(apparent_elevation_rad, 0.0, 0.5 * pi);
  const double s = std::sin(h);
  const double bound = aside_above_ - (aside_above_ - aside_at_horizon_) * std::exp(-s / 0.05);
  return refractivity_ * scale_height_m_ * std::cos(h) / (s * s + bound);
}

double Refraction::of_body_rad(double apparent_elevation_rad, double distance_m) const {
  const double of_star = at_apparent_rad(apparent_elevation_rad);
  if (distance_m == star) return of_star;
  const double aside = aside_m(apparent_elevation_rad) / distance_m;
  return of_star - std::asin(std::min(aside, std::sin(of_star)));
}

double Refraction::true_from_apparent_rad(double apparent_elevation_rad, double distance_m) const {
  if (bennett_scale_ == 0.0) return apparent_elevation_rad;
  return apparent_elevation_rad - of_body_rad(apparent_elevation_rad, distance_m);
}

// Solves apparent - R(apparent) = true by secants. R falls by less than 0.25 per unit, so that two
// plain repetitions start well inside.
double Refraction::apparent_from_true_rad(double true_elevation_rad, double distance_m) const {
  if (bennett_scale_ == 0.0) return true_elevation_rad;
  const auto repeat = [&](double apparent) {
    return true_elevation_rad + of_body_rad(apparent, distance_m);
  };
  double a = repeat(true_elevation_rad), b = repeat(a);
  double error_a = a - b;
  for (int i = 0; i < 30; ++i) {
    const double error_b = b - repeat(b);
    if (std::abs(error_b) < 1e-14 || error_b == error_a) break;
    const double next = b - error_b * (b - a) / (error_b - error_a);
    a = b;
    error_a = error_b;
    b = next;
  }
  return b;
}

// Where the series alone holds, R = series(tan(z - R)) by Newton's method from R = series(tan z),
// which is off by 4e-2 of R at most; R stays below 0.02, so that its powers beyond the fifth are
// nothing.
Refraction::Elevation Refraction::apparent_from_true(const Elevation& truly,
                                                     double distance_m) const {
  static const double lowest_sine = std::sin(series_ends_rad);
  if (bennett_scale_ == 0.0) return truly;
  if (distance_m != star || truly.sine < lowest_sine) {
    const double apparent =
        apparent_from_true_rad(std::atan2(truly.sine, truly.cosine), distance_m);
    return {std::sin(apparent), std::cos(apparent)};
  }
  const double tan_z = truly.cosine / truly.sine;
  double r = series_of_tan_rad(tan_z);
  for (int i = 0; i < 2; ++i) {
    const double tan_r = r * (1 + r * r * (1.0 / 3 + r * r * (2.0 / 15)));
    const double u = (tan_z - tan_r) / (1 + tan_z * tan_r);
    const double slope = (tan_term_rad_ + 3 * tan3_term_rad_ * u * u) * (1 + u * u);
    r -= (r - series_of_tan_rad(u)) / (1 + slope);
  }
  const double sin_r = r * (1 - r * r * (1.0 / 6 - r * r / 120)),
               cos_r = 1 - r * r * (0.5 - r * r / 24);
  return {truly.sine * cos_r + truly.cosine * sin_r, truly.cosine * cos_r - truly.sine * sin_r};
}

}  // namespace dmise
