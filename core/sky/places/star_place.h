#pragma once
#include "core/frames/vec.h"

namespace dmise {

/// A star as a catalogue gives it, ICRS, at `epoch_jyear`.
struct StarPlace {
  double ra_rad = 0.0;
  double dec_rad = 0.0;
  double pm_ra_cosdec_rad_per_yr = 0.0;  // on the sky, so finite at the poles
  double pm_dec_rad_per_yr = 0.0;
  double parallax_rad = 0.0;
  double radial_velocity_m_per_s = 0.0;  // receding is positive
  double epoch_jyear = 2000.0;           // Julian year, TT
};

/// A star with the axes at its catalogued place, unit vectors.
struct CataloguedStar {
  const StarPlace& star;
  Vec<Gcrs> outward, east, north;

  explicit CataloguedStar(const StarPlace& place);
  /// A star where the direction of the place is known (unit).
  CataloguedStar(const StarPlace& place, const Vec<Gcrs>& direction);
};

}  // namespace dmise
