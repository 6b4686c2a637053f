#pragma once
#include <vector>

namespace dmise {

/// The light of an object that burns in the air, alike in all directions.
struct ReentryLight {
  std::vector<double> height_m;  // over the ellipsoid, ascending, two or more
  std::vector<double> v_mag;     // at `range_m`, one for each height
  double range_m = 100e3;        // from which the magnitudes are; meteors have 100 km

  /// Light at `range_m` over that of magnitude 0. Magnitudes are linear between heights; beyond the
  /// first and the last there is none.
  double at(double height) const;

  bool operator==(const ReentryLight&) const = default;
};

}  // namespace dmise
