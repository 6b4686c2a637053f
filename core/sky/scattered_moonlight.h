#pragma once
#include "core/effects/plan_facts.h"

namespace dmise {

/// Moonlight scattered by the air.
struct ScatteredMoonlight {
  static constexpr EffectFacts facts{"scattered_moonlight", "moonlight scattered by the air",
                                     "up to 18 mag/arcsec2 at full Moon",
                                     "Krisciunas & Schaefer 1991, PASP 103, 1033"};
  static bool applies(const SceneFacts& scene) { return scene.on_ground; }
  static ErrorBound error(int, const PlanFacts& f) {
    return f.without_part(SkyPart::scattered_moonlight);
  }
  static double cost_s(int level, const PlanFacts& f) { return level * 245e-9 * f.sky_looks(); }

  double factor = 1.0;  // for hazier air than that of the source
};

/// V magnitude of the Moon at its mean distance by its phase angle (Sun-Moon-observer) [rad, 0 at
/// full Moon]. Source: Krisciunas & Schaefer 1991, PASP 103, 1033, equation 9.
double moon_v_mag(double phase_rad);

/// Radius of the Moon [deg]: nearer to its centre moonlight is that of its limb.
inline constexpr double moonlight_held_within_deg = 0.25;

/// Scattering function f at an angle [rad] from the Moon, equations 16, 18 and 19 there. Where 18
/// and 19 would jump (10 deg) the larger of both is taken, and the pole at 0 is held inside
/// `moonlight_held_within_deg`.
double moonlight_scattering(double angle_from_moon_rad);

/// Brightness [S10 in V] at the ground, equation 15 there. Below the horizon the Moon's light falls
/// by 0.9 mag a degree, so that moonrise is continuous. `k_v` in mag/airmass.
double scattered_moonlight_s10(double angle_from_moon_rad, double sin_altitude,
                               double sin_moon_altitude, double moon_v_mag, double k_v);

}  // namespace dmise
