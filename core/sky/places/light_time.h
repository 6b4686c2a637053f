#pragma once
#include "core/base/units.h"
#include "core/effects/effects.h"
#include "core/frames/vec.h"

namespace dmise {

/// Satellites, Sun and Moon are seen where they were when their light left.
struct LightTime {
  static constexpr EffectFacts facts{
      "light_time", "objects are seen where they were when the light left",
      "up to 5.2 arcsec; the Sun 20.5", "three iterations of range / c"};

  // It has no cost, so that no plan leaves it out where it displaces something: alike in every
  // frame along an object's path, which tracks do not average out as they do other errors. It takes
  // a microsecond for each object.
  static ErrorBound error(int, const PlanFacts& f);

  /// `line_m(dt_s)`: from the observer now to the object at now + dt_s. Returns the line along
  /// which its light comes [m] and sets `light_time_s`.
  template <class Line>
  Vec<Gcrs> apply(Line&& line_m, Vec<Gcrs> line_now_m, double& light_time_s) const {
    // Each turn gains a factor v/c: three end below a picosecond.
    for (int i = 0; i < 3; ++i) {
      light_time_s = norm(line_now_m) / speed_of_light_m_per_s;
      line_now_m = line_m(-light_time_s);
    }
    return line_now_m;
  }
};

}  // namespace dmise
