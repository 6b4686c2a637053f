#pragma once
#include "core/effects/effects.h"
#include "core/photometry/spectrum.h"

namespace dmise {

/// Moonlight scattered by the air.
struct ScatteredMoonlight {
  static constexpr EffectFacts facts{"scattered_moonlight", "moonlight scattered by the air",
                                     "up to 18 mag/arcsec2 at full Moon",
                                     "Krisciunas & Schaefer 1991, PASP 103, 1033"};
  static bool applies(const SceneFacts& scene) { return scene.on_ground; }
  static ErrorBound error(int, const PlanFacts& f);
  static double cost_s(int level, const PlanFacts& f);

  double factor = 1.0;  // for hazier air than that of the source
};

/// V magnitude of the Moon at its mean distance by its phase angle (Sun-Moon-observer) [rad, 0 at
/// full Moon]. Source: Krisciunas & Schaefer 1991, PASP 103, 1033, equation 9.
double moon_v_mag(double phase_rad);

/// Radius of the Moon [deg]: nearer to its centre moonlight is that of its limb.
inline constexpr double moonlight_held_within_deg = 0.25;

/// Correction of `moon_v_mag` near opposition [mag, <= 0]: 35 % brighter at full Moon, none from 7
/// deg on. Source: Krisciunas & Schaefer 1991; linear between in magnitudes.
double opposition_surge_mag(double phase_rad);

/// Moonlight above the air, up to a factor: sunlight times the reflectance of the Moon's disc.
/// Source: Kieffer & Stone 2005, AJ 129, 2887 (tests/reference/lunar_reflectance.py), 4 %.
const Spectrum& moonlight_spectrum();

/// The air of a band for scattered moonlight: its extinction towards the zenith [mag/airmass], and
/// how much of it is scattering by molecules and by haze, each over its share in V.
struct MoonlitAir {
  double extinction_mag = 0.0;
  double molecules = 1.0, haze = 1.0;
};
/// `k_v` and `k`: extinction in V and in the band. Molecules scatter by the wavelength to the power
/// -4.08, haze to -1.3 (Patat et al. 2011, A&A 527, A91: -1.38).
MoonlitAir moonlit_air(const Band& band, double k_v, double k);

/// Scattering function f at an angle [rad] from the Moon, equations 16, 18 and 19 there. Where 18
/// and 19 would jump (10 deg) the larger of both is taken, and the pole at 0 is held inside
/// `moonlight_held_within_deg`. `air` scales the terms of molecules and of haze.
double moonlight_scattering(double angle_from_moon_rad, const MoonlitAir& air = {});

/// Brightness at the ground, equation 15 there [S10 of the Moon's colour above the air]. Below the
/// horizon the Moon's light falls by 0.9 mag a degree, so that moonrise is continuous.
double scattered_moonlight_s10(double angle_from_moon_rad, double sin_altitude,
                               double sin_moon_altitude, double moon_v_mag, const MoonlitAir& air);

}  // namespace dmise
