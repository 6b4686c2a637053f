#pragma once
#include <optional>

#include "core/effects/effects.h"
#include "core/frames/oblate_earth.h"

namespace dmise {

/// Lines of sight past the Earth from one place: a point in space or a site on the ground, also one
/// below the ellipsoid, which sees what is above its tangent plane. Straight lines: refraction
/// lifts a grazing ray by 1.1 deg, and no terrain. A few multiplications a line.
class FreeSight {
 public:
  FreeSight(const Vec<Gcrs>& from_m, const OblateEarth& earth);

  /// Whether the straight line to `to_m` stays outside the ellipsoid. False when `to_m` is inside.
  bool clear(const Vec<Gcrs>& to_m) const;

  /// Whether a line without an end is clear, for stars. `direction` of any length > 0.
  bool clear_direction(const Vec<Gcrs>& direction) const;

  const OblateEarth& earth() const { return earth_; }

 private:
  bool passes(const Vec<Gcrs>& line, double along) const;

  OblateEarth earth_;
  Vec<Gcrs> from_;  // stretched
  double from_squared_ = 0;
  double radius_squared_ = 0;
};

/// The Earth hides what is behind it: below the apparent horizon on the ground, behind the
/// ellipsoid in orbit.
class EarthOccultation {
 public:
  static constexpr EffectFacts facts{"earth_occultation", "the Earth hides what is behind it",
                                     "objects and stars behind it are drawn",
                                     "line of sight and ellipsoid"};

  static ErrorBound error(int, const PlanFacts& f);
  static double cost_s(int level, const PlanFacts& f);

  /// `up`: unit, the normal of the ellipsoid at a ground sensor. `sight`: of one in orbit.
  EarthOccultation(const Vec<Gcrs>& up, const std::optional<FreeSight>& sight)
      : up_(up), sight_(sight) {}

  /// Whether it hides what is infinitely far in an apparent direction (unit).
  bool hides_direction(const Vec<Gcrs>& apparent) const {
    return sight_ ? !sight_->clear_direction(apparent) : dot(up_, apparent) < 0.0;
  }
  /// Whether it hides an object at `position_m` (geocentric) that is seen in a direction (unit).
  bool hides_object(const Vec<Gcrs>& position_m, const Vec<Gcrs>& apparent) const {
    return sight_ ? !sight_->clear(position_m) : dot(up_, apparent) < 0.0;
  }

 private:
  Vec<Gcrs> up_;
  std::optional<FreeSight> sight_;  // in orbit
};

}  // namespace dmise
