#pragma once
#include "core/frames/sky_frames.h"
#include "core/frames/vec.h"

namespace dmise {

/// Stars per square degree by V magnitude in one direction of the Galaxy, to V = 21; linear in log
/// N between whole magnitudes and, with the slopes at the ends, beyond them.
///
/// By galactic latitude: to V = 11 as counted in Tycho-2; from |b| = 20 deg on the fit of Bahcall &
/// Soneira 1980, ApJS 44, 73, appendix B (V), which the counts of Tycho-2 join between V = 11 and
/// 16; nearer to the plane, where it has no dust, log N rises evenly so far that the whole sky has
/// the stars of Tycho-2 with UCAC4 to V = 16 and of USNO-B1.0 to V = 21 (within 30 and 20 %). By
/// longitude: the fit's ratio to its mean, nearer to the plane that of 20 deg. There are no dust
/// clouds and no clusters: a degree of the Milky Way may have half or twice as many.
class StarCounts {
 public:
  static constexpr double first_v_mag = 9.0, last_v_mag = 21.0;

  /// `direction`: unit.
  explicit StarCounts(const Vec<Galactic>& direction);

  /// Stars per square degree brighter than `v_mag`.
  double brighter_than(double v_mag) const;

  /// Light of the stars between two magnitudes, S10: stars of V = 10 per square degree. Consistent
  /// with stars drawn by `magnitude_of`.
  double light_s10(double from_v_mag, double to_v_mag) const;

  /// The magnitude than which a `share` of the stars between two magnitudes are brighter. Both are
  /// within one step of the table.
  double magnitude_of(double from_v_mag, double to_v_mag, double share) const;

 private:
  static constexpr int nodes = 13;
  double slope_at(double v_mag) const;

  double log_n_[nodes];
};

/// Stars of the whole sky brighter than `v_mag`, by the same counts, to 1 %.
double stars_of_all_sky(double v_mag);

/// Brightness of all stars fainter than `v_mag`, S10, by the same counts; they are continued to
/// V = 25.
double starlight_of_counts_s10(double v_mag, const Vec<Galactic>& direction);

}  // namespace dmise
