#pragma once
#include <array>
#include <optional>
#include <vector>

#include "core/photometry/band.h"
#include "core/sky/air/air_gases.h"
#include "core/sky/air/haze.h"

namespace dmise {

/// What the day sky over a site depends on, beside the Sun.
struct DayAir {
  double height_m = 0.0;  // site over the sea
  double pressure_hpa = 1013.25;
  Haze haze;
  double ground_albedo = 0.2;     // Lambertian, at all wavelengths
  std::optional<AirGases> gases;  // none: they absorb nothing

  bool operator==(const DayAir&) const = default;
};

/// Where a line of sight is, as the sky's light goes.
struct DayDirection {
  double sin_altitude;          // below 0 it counts as 0
  double azimuth_from_sun_rad;  // any sign
  double cos_angle_from_sun;
};

/// Sunlight that clear air scatters towards the ground in a band, from 10 deg of twilight to noon.
/// Light scattered once is summed along straight lines through spherical shells, with the phase
/// functions of molecules and haze themselves; light scattered more often, and that of the ground,
/// comes from `DiffuseLight` along the same lines (Nakajima & Tanaka 1988, J. Quant. Spectrosc.
/// Radiat. Transfer 40, 51). The band is cut into pieces of 6 % in wavelength. Gases absorb along
/// the ways of light scattered once, and take the same share of the rest. The Sun is at 1 au and
/// its rays are straight.
class DaySky {
 public:
  DaySky(const Band& band, const DayAir& air, double sin_sun_altitude);

  /// Photons/s/m2/sr, from tables in altitude and azimuth for each part of the light.
  double photons_per_s_m2_sr(const DayDirection& direction) const;

 private:
  /// Light scattered once by molecules and by haze, over their phase functions, and all other.
  struct Parts {
    double molecules = 0.0, haze = 0.0, diffuse = 0.0;
  };
  struct Sums;

  std::vector<Parts> parts_;  // altitudes x azimuths
};

}  // namespace dmise
