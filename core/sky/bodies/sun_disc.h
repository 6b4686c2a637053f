#pragma once
#include "core/effects/effects.h"
#include "core/photometry/band.h"

namespace dmise {

/// The Sun's disc, which darkens towards its limb, where it is in the field.
struct SunDisc {
  static constexpr EffectFacts facts{"sun_disc", "the Sun's disc, where it is in the field",
                                     "no Sun in the field",
                                     "Hestroffer & Magnan 1998, A&A 333, 338"};
  static bool applies(const SceneFacts& scene) { return scene.sun_in_field; }
  static ErrorBound error(int, const PlanFacts& f);
  static double cost_s(int level, const PlanFacts& f);
};

inline constexpr double sun_radius_m = 695.7e6;  // IAU 2015 Resolution B3

/// Exponent of the law of limb darkening I(mu) = mu^alpha at a wavelength, mu the cosine of the
/// angle between ray and normal. Source: Hestroffer & Magnan 1998; held at 0 beyond 12 um.
double sun_limb_exponent(double wavelength_m);

/// The Sun's radiance in a band: its disc gives the irradiance of `sun_v_mag` at 1 au.
class SunRadiance {
 public:
  SunRadiance(const Band& band, double distance_m);
  double angular_radius_rad() const { return radius_rad_; }
  /// Photons/s/m2/sr at an angle from the disc's centre; negative beyond its limb.
  double photons_per_s_m2_sr(double from_centre_rad) const;

 private:
  double radius_rad_, sine_, exponent_, centre_;
};

}  // namespace dmise
