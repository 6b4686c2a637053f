#pragma once
#include "core/frames/oblate_earth.h"

namespace dmise {

/// What the Earth leaves free to see from one place: a point in space or a site on the ground, also
/// one below the ellipsoid, which sees what stands above its tangent plane. Straight lines:
/// refraction lifts a grazing ray by 1.1 deg, and no terrain. A few multiplications a line.
class FreeSight {
 public:
  FreeSight(const Vec<Gcrs>& from_m, const OblateEarth& earth);

  /// Whether the straight line to `to_m` stays outside the ellipsoid. False when `to_m` is inside.
  bool clear(const Vec<Gcrs>& to_m) const;

  /// The same without an end, for stars. `direction` of any length > 0.
  bool clear_direction(const Vec<Gcrs>& direction) const;

  const OblateEarth& earth() const { return earth_; }

 private:
  bool passes(const Vec<Gcrs>& line, double along) const;

  OblateEarth earth_;
  Vec<Gcrs> from_;  // stretched
  double from_squared_ = 0;
  double radius_squared_ = 0;
};

bool line_of_sight_clear(const Vec<Gcrs>& from_m, const Vec<Gcrs>& to_m, const OblateEarth& earth);

}  // namespace dmise
