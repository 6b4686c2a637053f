#pragma once
#include "core/effects/effects.h"
#include "core/photometry/spectrum.h"

namespace dmise {

/// Sunlight scattered high up while the Sun is below the horizon: brightest above where it stands.
struct Twilight {
  static constexpr EffectFacts facts{
      "twilight", "sunlight scattered by the air with the Sun below the horizon",
      "18 mag/arcsec2 with the Sun 10 deg down",
      "Patat et al. 2006, A&A 455, 385; Schaefer 1993, Vistas in Astronomy 36, 311"};
  static bool applies(const SceneFacts& scene) { return scene.on_ground; }
  static ErrorBound error(int, const PlanFacts& f);
  static double cost_s(int level, const PlanFacts& f);

  double factor = 1.0;
};

/// Brightness of the zenith [S10 in V] by the Sun's altitude [rad]. Depression 5-14 deg: 11.84 +
/// 1.518 x - 0.057 x^2 mag/arcsec2, x = depression - 5 deg, the dark sky of 21.7 subtracted.
/// Source: Patat, Ugolnikov & Postylyakov 2006, A&A 455, 385, table 1. Deeper, it goes on falling
/// at the slope of 14 deg and by the square of the rest (it is gone, below 1 S10, at 18 deg);
/// higher, it joins 7.2 mag/arcsec2 at sunset (+-0.5 mag) and is held at 4 by day.
double twilight_zenith_s10(double sun_altitude_rad);

/// Relative brightness of a direction: only its ratio to that of the zenith has a meaning. More air
/// near the horizon, brighter near the Sun. `k_v` in mag/airmass, held at 0.05 and more. Source:
/// Schaefer 1993, Vistas in Astronomy 36, 311, twilight term.
double twilight_pattern(double sin_altitude, double angle_from_sun_rad, double k_v);

/// Colour by the Sun's altitude [rad], 0.2-2.5 um: sunlight times factors that give it the UBVRI of
/// Patat et al. 2006, table 1, for depressions of 5 to 14 deg, the night sky of Patat 2003
/// subtracted; held outside of them.
Spectrum twilight_spectrum(double sun_altitude_rad);

}  // namespace dmise
