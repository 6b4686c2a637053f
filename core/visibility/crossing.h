#pragma once
#include <optional>

#include "core/base/sim_time.h"

namespace dmise {

/// Returns an instant between `a` and `b` at which `distance_m` is below 0, if there is one; at
/// both ends it is not. `may_cross(d_a, d_b, seconds)` says whether an object at these distances
/// can reach 0 in between: if it can, the interval is bisected down to `shortest_s`. Longer
/// crossings are found for certain if `may_cross` is conservative.
template <class MayTouch, class Distance>
std::optional<SimTime> crossing_between(SimTime a, double a_m, SimTime b, double b_m,
                                        double shortest_s, const MayTouch& may_cross,
                                        const Distance& distance_m) {
  const double length_s = (b - a).seconds();
  if (length_s < shortest_s || !may_cross(a_m, b_m, length_s)) return std::nullopt;
  const SimTime middle{a.ns + (b.ns - a.ns) / 2};
  const double middle_m = distance_m(middle);
  if (middle_m < 0.0) return middle;
  if (const auto first =
          crossing_between(a, a_m, middle, middle_m, shortest_s, may_cross, distance_m))
    return first;
  return crossing_between(middle, middle_m, b, b_m, shortest_s, may_cross, distance_m);
}

}  // namespace dmise
