#pragma once
#include "core/effects/effects.h"
#include "core/photometry/band.h"

namespace dmise {

/// Sunlight scattered by interplanetary dust, above the atmosphere, redder than the Sun; its yearly
/// change (10 %) is left out.
struct ZodiacalLight {
  static constexpr EffectFacts facts{
      "zodiacal_light", "sunlight scattered by dust between the planets",
      "23.3 mag/arcsec2 at the ecliptic poles, 22 and brighter near the ecliptic",
      "Leinert et al. 1998, A&AS 127, 1, table 17"};
  static ErrorBound error(int, const PlanFacts& f);
  static double cost_s(int level, const PlanFacts& f);

  double factor = 1.0;  // on the table
};

/// Brightness [S10] at 500 nm by ecliptic longitude from the Sun and ecliptic latitude [rad, any].
/// The table's own values at its nodes, a bicubic of the logarithm with continuous slopes between
/// them; within 15 deg of the Sun, where the table ends, the power -2.2 of elongation continues it,
/// held inside 2.5 deg. Source: Leinert et al. 1998, A&AS 127, 1, table 17; 1 S10 is 1.28e-8
/// W/m2/sr/um.
double zodiacal_light_s10(double longitude_from_sun_rad, double latitude_rad);

/// Its light over sunlight is 1 + slope x redness: the slope by the angle from the Sun [rad], 0.8
/// to 30 deg, 0.6 from 90 deg on, linear between; the redness log10(wavelength / 500 nm), 1.5 times
/// that below 500 nm. Held outside 0.22-2.5 um. Source: Leinert et al. 1998, section 8.4.2.
double zodiacal_slope(double angle_from_sun_rad);
/// Mean redness of sunlight's photons in a band.
double zodiacal_redness(const Band& band);

}  // namespace dmise
