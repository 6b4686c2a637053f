#pragma once
#include <span>
#include <vector>

#include "core/optics/deposit.h"

namespace dmise {

/// Time-delay integration: what `count` snapshots, evenly spaced in the middles of equal parts of
/// the exposure, see of a source whose path is `path`, consecutive arcs of equal time. Each is a
/// point with the brightness of its moment; together they have the path's light. Light falls beside
/// the path integral by at most half the way between two snapshots, and converges to it as
/// 1/count^2 in the middle and 1/count at the ends.
std::vector<Arc> as_snapshots(std::span<const Arc> path, int count);

}  // namespace dmise
