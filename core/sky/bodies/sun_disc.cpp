#include "core/sky/bodies/sun_disc.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/effects/plan_facts.h"
#include "core/photometry/magnitude.h"

namespace dmise {

ErrorBound SunDisc::error(int, const PlanFacts& f) {
  return f.scene.sun_in_field ? not_bounded : ErrorBound{};
}

double SunDisc::cost_s(int level, const PlanFacts& f) { return level * 400e-9 * f.pixels(); }

double sun_limb_exponent(double wavelength_m) {
  return std::max(0.0, -0.023 + 0.292e-6 / wavelength_m);
}

SunRadiance::SunRadiance(const Band& band, double distance_m)
    : radius_rad_(std::asin(std::min(1.0, sun_radius_m / distance_m))),
      sine_(std::sin(radius_rad_)),
      exponent_(sun_limb_exponent(band.centre_m)) {
  const double au = distance_m / au_m;
  const double irradiance = sunlight_photons_per_s_m2(sun_v_mag, band) / (au * au);
  // The mean of mu^alpha over the disc is 2 / (2 + alpha).
  centre_ = irradiance / (pi * sine_ * sine_) * (1.0 + 0.5 * exponent_);
}

double SunRadiance::photons_per_s_m2_sr(double from_centre_rad) const {
  if (from_centre_rad > radius_rad_) return -1.0;
  const double r = std::min(1.0, std::sin(from_centre_rad) / sine_);
  return centre_ * std::pow(std::sqrt((1.0 - r) * (1.0 + r)), exponent_);
}

}  // namespace dmise
