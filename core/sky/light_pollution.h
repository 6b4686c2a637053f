#pragma once
#include <vector>
#include "core/effects/effects.h"

#include "core/frames/vec.h"
#include "core/photometry/spectrum.h"

namespace dmise {

/// Which lamps light the ground: shares of the light in V.
struct LampMix {
  double lps = 0.1;  // low-pressure sodium
  double hps = 0.5;  // high-pressure sodium
  double led = 0.4;  // white, 4000 K
};

/// The glow of one city on the horizon, over the even part.
struct CityGlow {
  double azimuth_rad = 0.0;          // from north through east
  double half_width_rad = 0.7;       // standard deviation in azimuth
  double height_rad = 0.26;          // altitude at which it has fallen to 1/e
  double horizon_over_zenith = 5.0;  // its peak, in units of the even part's zenith
};

/// Light of lamps scattered by the air.
struct LightPollution {
  static constexpr EffectFacts facts{"light_pollution", "light of lamps scattered by the air",
                                     "18 mag/arcsec2 in a city",
                                     "a zenith brightness and its rise to the horizon"};
  static bool applies(const SceneFacts& scene) { return scene.on_ground; }
  static ErrorBound error(int, const PlanFacts& f);
  static double cost_s(int level, const PlanFacts& f);

  double zenith_v_mag_per_arcsec2 = 18.0;  // the even part alone
  LampMix lamps;
  std::vector<CityGlow> cities;
};

/// Brightness [S10 in V] at the ground. Even part: single scattering, (1 - T(X)) / (1 - T(1)) with
/// T of the air's extinction `k_v` [mag/airmass] and X to 5 at the horizon: 3.8 times the zenith
/// there.
double light_pollution_s10(const LightPollution& pollution, const Vec<Enu>& direction, double k_v);

/// Spectrum of the mix, 0.2-2.5 um, and none to 100 um: each lamp as a sum of lines with their
/// widths. Low-pressure sodium: the D lines; high-pressure sodium: D lines reversed and broadened,
/// their neighbours and 819 nm; LED: blue die and phosphor. Throws `Error` for shares below 0 or
/// all 0.
Spectrum lamp_spectrum(const LampMix& lamps);

}  // namespace dmise
