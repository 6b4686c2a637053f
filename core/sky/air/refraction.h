#pragma once
#include <array>
#include <limits>

namespace dmise {

/// Air at the observer.
struct Weather {
  double pressure_hpa = 1013.25;  // [0, 10000]; 0 is no air
  double temperature_c = 15.0;    // [-150, 200]
  double humidity = 0.5;          // relative, [0, 1]

  bool operator==(const Weather&) const = default;
};

/// International Standard Atmosphere at a height above the sea, which stands in for the one above
/// the ellipsoid; isothermal from 11 km up.
Weather standard_weather(double height_m);

/// Refractivity of dry air over wavelength: 1e6 (n - 1) T / P [K/hPa], as eraRefco has it; and the
/// wavelength [m] of one.
double dry_air_refractivity(double wavelength_m);
double wavelength_of_dry_air_m(double refractivity);

/// Bending of light by the air over a ground site. Elevations are over its horizon; "true" is as
/// without air, "apparent" is what the camera sees. To 75 deg from the zenith ERFA's eraRefco, from
/// 80 deg down Bennett 1982 scaled to join it and brought to rays that were traced through standard
/// atmospheres of -20 to 35 C and 620 to 1013 hPa, between them a smooth blend; constant under the
/// apparent horizon. Finite and monotone at every elevation. Traced rays differ by 0.1 arcsec to 75
/// deg, by 0.2 % below. Real air differs from any standard one, at the horizon by several percent.
///
/// A body at a finite distance above the air is lifted less than a star: its light comes along a
/// line that passes the observer aside. `distance_m` is along the straight line to it.
class Refraction {
 public:
  static constexpr double star = std::numeric_limits<double>::infinity();  // as a distance

  /// No air: elevations pass unchanged.
  Refraction() = default;
  /// `wavelength_um`: [0.1, 100]. Throws `Error` for numbers that are not finite or out of range.
  explicit Refraction(const Weather& weather, double wavelength_um = 0.55);

  /// Refraction of a star at this apparent elevation: apparent minus true [rad, >= 0].
  double at_apparent_rad(double apparent_elevation_rad) const;

  double apparent_from_true_rad(double true_elevation_rad, double distance_m = star) const;
  /// An elevation given by its sine and cosine (>= 0): for most stars nothing but
  /// arithmetic.
  struct Elevation {
    double sine, cosine;
  };
  Elevation apparent_from_true(const Elevation& truly, double distance_m = star) const;
  double true_from_apparent_rad(double apparent_elevation_rad, double distance_m = star) const;

  /// Distance from the observer [m] of the line along which light enters the air that arrives at
  /// this apparent elevation: a body at `distance_m` is lifted less than a star by aside /
  /// distance.
  double aside_m(double apparent_elevation_rad) const;
  /// What it was made of; pressure 0 for no air.
  const Weather& weather() const { return weather_; }
  double wavelength_um() const { return wavelength_um_; }

 private:
  double series_rad(double apparent_elevation_rad) const;
  double series_of_tan_rad(double tan_z) const;
  double bennett_rad(double apparent_elevation_rad) const;
  double of_body_rad(double apparent_elevation_rad, double distance_m) const;

  Weather weather_{.pressure_hpa = 0.0};
  double wavelength_um_ = 0.55;
  double tan_term_rad_ = 0.0, tan3_term_rad_ = 0.0;  // factors of tan z and tan^3 z, z apparent
  double bennett_scale_ = 0.0;                       // 0: no air
  std::array<double, 2> bends_{};                    // how much more traced rays are bent
  double refractivity_ = 0.0;                        // n - 1 at the observer
  double scale_height_m_ = 0.0;                      // by which density falls at the observer
  double aside_at_horizon_ = 1.0;                    // keeps `aside_m` finite: its two constants
  double aside_above_ = 1.0;
};

}  // namespace dmise
