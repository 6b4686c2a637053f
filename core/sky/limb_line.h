#pragma once
#include <algorithm>
#include <cmath>

#include "core/frames/oblate_earth.h"

namespace dmise {

/// A line of sight past the Earth, in the space in which the ellipsoid is a sphere of the equator's
/// radius: heights in it are the true ones to 0.34 %.
struct LimbLine {
  double radius_m = 0.0;
  double nearest_m = 0.0;   // least distance of the whole line from the centre
  double from_m = 0.0;      // where the observer is along it, from that place; < 0: it lies ahead
  double true_scale = 1.0;  // true length over length
  Vec<Gcrs> line;           // unit
  Vec<Gcrs> nearest;        // its nearest place to the centre

  double tangent_height_m() const { return nearest_m - radius_m; }
  /// Lowest height of the part that lies ahead.
  double lowest_height_m() const {
    return (from_m < 0.0 ? nearest_m : std::hypot(nearest_m, from_m)) - radius_m;
  }
  /// Whether the ground ends it.
  bool meets_ground() const { return from_m < 0.0 && nearest_m < radius_m; }
};

/// The lines of sight from one place outside the ellipsoid.
class LimbSight {
 public:
  LimbSight(const Vec<Gcrs>& from_m, const OblateEarth& earth)
      : earth_(earth), from_(earth.stretched(from_m)), from_squared_(dot(from_, from_)) {}

  const OblateEarth& earth() const { return earth_; }
  /// `direction`: of any length > 0.
  LimbLine line(const Vec<Gcrs>& direction) const {
    const Vec<Gcrs> stretched = earth_.stretched(direction);
    const double length = norm(stretched);
    const Vec<Gcrs> line = stretched / length;
    const double along = dot(line, from_);
    return {.radius_m = earth_.ellipsoid.equatorial_radius_m,
            .nearest_m = std::sqrt(std::max(0.0, from_squared_ - along * along)),
            .from_m = along,
            .true_scale = norm(direction) / length,
            .line = line,
            .nearest = from_ - line * along};
  }

 private:
  OblateEarth earth_;
  Vec<Gcrs> from_;  // stretched
  double from_squared_;
};

}  // namespace dmise
