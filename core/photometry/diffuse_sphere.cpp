#include "core/photometry/diffuse_sphere.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/photometry/magnitude.h"

namespace dmise {

double diffuse_phase_function(double phase_rad) {
  const double from_dark = std::clamp(pi - phase_rad, 0.0, pi);
  // sin e - e cos e cancels near e = 0, where its series holds: the first term left out is
  // e^9/45360.
  const double e2 = from_dark * from_dark;
  const double shape =
      from_dark < 0.1 ? from_dark * e2 * (1.0 / 3 - e2 * (1.0 / 30 - e2 * (1.0 / 840 - e2 / 45360)))
                      : std::sin(from_dark) - from_dark * std::cos(from_dark);
  return 2.0 / (3.0 * pi * pi) * shape;
}

double diffuse_sphere_light(const DiffuseSphere& sphere, const Illumination& seen) {
  if (!(seen.range_m > 0) || !std::isfinite(seen.range_m))
    throw Error("diffuse sphere: range must be > 0, got " + std::to_string(seen.range_m) + " m");
  if (!(seen.sun_distance_au > 0) || !std::isfinite(seen.sun_distance_au))
    throw Error("diffuse sphere: distance from the Sun must be > 0, got " +
                std::to_string(seen.sun_distance_au) + " au");
  const double size = sphere.radius_m / seen.range_m;
  return seen.sunlit * pi * size * size * sphere.albedo * diffuse_phase_function(seen.phase_rad) /
         (seen.sun_distance_au * seen.sun_distance_au);
}

double diffuse_sphere_magnitude(const DiffuseSphere& sphere, const Illumination& seen) {
  const double light = diffuse_sphere_light(sphere, seen);
  return light > 0 ? std::min(sun_v_mag + magnitude_of_light(light), darkest_mag) : darkest_mag;
}

double object_photons_per_s_m2(double v_mag, const Band& band) {
  return v_mag < darkest_mag ? sunlight_photons_per_s_m2(v_mag, band) : 0.0;
}

double radius_from_standard(const StandardMagnitude& standard, double albedo) {
  const double light_of_1_m =
      diffuse_sphere_light({.radius_m = 1.0, .albedo = albedo},
                           {.range_m = standard.range_m, .phase_rad = standard.phase_rad});
  if (!(light_of_1_m > 0)) throw Error("standard magnitude: the sphere is dark at its phase");
  return std::sqrt(light_of_magnitude(standard.v_mag - sun_v_mag) / light_of_1_m);
}

double magnitude_from_standard(const StandardMagnitude& standard, const Illumination& seen) {
  constexpr double albedo = 1.0;  // it cancels
  return diffuse_sphere_magnitude({radius_from_standard(standard, albedo), albedo}, seen);
}

}  // namespace dmise
