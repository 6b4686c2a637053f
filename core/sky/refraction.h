#pragma once

namespace dmise {

/// Air at the observer.
struct Weather {
  double pressure_hpa = 1013.25;  // [0, 10000]; 0 is no air
  double temperature_c = 15.0;    // [-150, 200]
  double humidity = 0.5;          // relative, [0, 1]
};

/// International Standard Atmosphere at a height above the sea, which stands in for the one above
/// the ellipsoid; isothermal from 11 km up.
Weather standard_weather(double height_m);

/// Bending of light by the air over a ground site. Elevations are over its horizon; "true" is as
/// without air, "apparent" is what the camera sees. To 75 deg from the zenith ERFA's eraRefco (60
/// mas there), from 80 deg down Bennett 1982 (4 arcsec) scaled to join it, between them a smooth
/// blend; constant under the apparent horizon. Finite and monotone at every elevation.
class Refraction {
 public:
  /// None: elevations pass unchanged.
  Refraction() = default;
  /// `wavelength_um`: [0.1, 100]. Throws `Error` for numbers that are not finite or out of range.
  explicit Refraction(const Weather& weather, double wavelength_um = 0.55);

  /// How much higher than in truth a star stands at this apparent elevation [rad, >= 0].
  double at_apparent_rad(double apparent_elevation_rad) const;

  double apparent_from_true_rad(double true_elevation_rad) const;
  double true_from_apparent_rad(double apparent_elevation_rad) const;

  /// For a body at a finite distance above the air, which is lifted less than a star: its light
  /// comes along a line that passes the observer aside. `true_elevation_rad` is that of the
  /// straight line, `observer_radius_m` the observer's distance from the Earth's centre.
  double apparent_from_true_rad(double true_elevation_rad, double distance_m,
                                double observer_radius_m) const;
  double true_from_apparent_rad(double apparent_elevation_rad, double distance_m,
                                double observer_radius_m) const;

 private:
  double series_rad(double apparent_elevation_rad) const;
  double bennett_rad(double apparent_elevation_rad) const;
  double offset_per_radius(double apparent_elevation_rad) const;
  double of_body_rad(double apparent_elevation_rad, double radius_per_distance) const;
  double lifted(double true_elevation_rad, double radius_per_distance) const;

  double tan_term_rad_ = 0.0, tan3_term_rad_ = 0.0;  // of the apparent zenith distance
  double refractivity_ = 0.0;                        // n - 1 at the observer
  double scale_height_ = 0.0;                        // of the air, in observer's radii
  double horizon_flattening_ = 1.0;                  // keeps the offset finite at the horizon
  double bennett_scale_ = 0.0;
};

}  // namespace dmise
