#pragma once
#include "core/effects/accuracy.h"
#include "core/effects/effects.h"
#include "core/frames/sky_frames.h"

namespace dmise {

/// Stars that are drawn one by one; the rest is smooth starlight.
struct DrawnStars {
  double to_v_mag = -unbounded;
  bool by_counts = false;  // synthetic stars are among them: the rest is by the same counts
};

/// Light of the stars below the catalogue's limit, above the atmosphere, smeared out.
struct FaintStarlight {
  static constexpr EffectFacts facts{"faint_starlight", "stars below the catalogue's limit",
                                     "22.2 to 24.5 mag/arcsec2",
                                     "Leinert et al. 1998, A&AS 127, 1, section 10"};
  static ErrorBound error(int, const PlanFacts& f);
  static double cost_s(int level, const PlanFacts& f);

  double brighter_limit_v_mag = 9.0;  // stars brighter than this are drawn one by one
  bool by_counts = false;             // the rest is by `StarCounts`
};

/// Brightness [S10 in V] by the sine of the galactic latitude, without structure along the Milky
/// Way (30 %). Fainter than V = 9: a slab of stars and dust, S (1 - exp(-tau / |sin b|)), 20 S10 at
/// the poles and 165 in the plane, thinning out by half every 2.5 mag of the limit. Between V = 5
/// and 9: 4.0 + 7.5 exp(-|b| / 17 deg) S10 a magnitude, as counted in the Hipparcos and Tycho
/// catalogues. Source of the sums over the sky: Leinert et al. 1998, A&AS 127, 1, section 10.
double faint_starlight_s10(const FaintStarlight& starlight, double sin_galactic_latitude);
/// Starlight in a direction (unit); by `StarCounts` where `by_counts` is set.
double faint_starlight_s10(const FaintStarlight& starlight, const Vec<Galactic>& direction);

}  // namespace dmise
