#pragma once
#include <span>
#include <vector>

#include "core/optics/blur/deposit.h"

namespace dmise {

/// Time-delay integration: `count` snapshots at the centres of equal parts of the exposure, of a
/// source whose path is `path`, consecutive arcs of equal time. Each is a point with the brightness
/// at its time; together they have the light of the path. Light is displaced from the path integral
/// by at most half the distance between snapshots and converges to it as 1/count^2 in the middle
/// and 1/count at the ends.
std::vector<Arc> as_snapshots(std::span<const Arc> path, int count);

}  // namespace dmise
