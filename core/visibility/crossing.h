#pragma once
#include <optional>

#include "core/base/sim_time.h"

namespace dmise {

/// An instant between `a` and `b` at which `distance_m` is below 0, if there is one. The distances
/// at both ends are not. `may_cross(d_a, d_b, seconds)` says whether a thing at these distances can
/// come to 0 in between: where it can, the time is cut in halves, down to `shortest_s`. What
/// touches for longer is found for certain when `may_cross` is right.
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
