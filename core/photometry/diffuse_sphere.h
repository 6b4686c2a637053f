#pragma once
#include "core/photometry/band.h"

namespace dmise {

/// An object without a known shape: a sphere of Lambert reflectance.
struct DiffuseSphere {
  double radius_m = 1.0;
  double albedo = 0.2;  // Lambert reflectance, (0, 1]

  bool operator==(const DiffuseSphere&) const = default;
};

/// Geometry and illumination of an observed object.
struct Illumination {
  double range_m = 1e6;          // observer to object
  double phase_rad = 0.0;        // Sun-object-observer, [0, pi]; beyond it is clamped
  double sun_distance_au = 1.0;  // Sun to object
  double sunlit = 1.0;           // fraction of the solar disc that shines on it, [0, 1]
};

/// Magnitude given to an object without light [mag].
inline constexpr double darkest_mag = 99.0;

/// F(phi) = 2/(3 pi^2) ((pi - phi) cos phi + sin phi): 2/(3 pi) at 0, exactly 0 at pi, relative
/// error below 1e-9 between. Source: Krag 1974, "Visible magnitude of typical satellites in
/// synchronous orbits".
double diffuse_phase_function(double phase_rad);

/// Fraction of the Sun's irradiance at 1 au that the sphere sends to the observer: sunlit A rho F /
/// (d^2 R^2), A = pi r^2. Throws `Error` for range or distance <= 0 or not finite.
double diffuse_sphere_light(const DiffuseSphere& sphere, const Illumination& seen);

/// V magnitude above the atmosphere, at most `darkest_mag`.
double diffuse_sphere_magnitude(const DiffuseSphere& sphere, const Illumination& seen);

/// Photons/s/m2 above the atmosphere in `band` of sunlight of magnitude `v_mag`; 0 from
/// `darkest_mag` on.
double object_photons_per_s_m2(double v_mag, const Band& band);

/// A catalogue's magnitude of an object at a stated range and phase, the Sun at 1 au. Catalogues
/// differ: most give 1000 km and 90 deg (half lit); some 0 deg, 1.24 mag brighter.
struct StandardMagnitude {
  double v_mag = 0.0;
  double range_m = 1e6;
  double phase_rad = 1.5707963267948966;
};

/// V magnitude in another geometry, with the phase curve of a diffuse sphere.
double magnitude_from_standard(const StandardMagnitude& standard, const Illumination& seen);

/// Radius [m] of the diffuse sphere of that brightness. Throws `Error` for a standard phase where
/// the sphere is dark.
double radius_from_standard(const StandardMagnitude& standard, double albedo);

}  // namespace dmise
