#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "core/orbit/attitude.h"

namespace dmise {

/// Triangulates a face of n corners, convex or not, into n - 2 triangles of corner indices (0..n-1)
/// with its orientation, by ear clipping on the coordinate plane that it faces most. A
/// self-intersecting face becomes a fan. O(n^2).
std::vector<std::array<std::uint32_t, 3>> triangulate(const std::vector<Vec<Body>>& corners);

}  // namespace dmise
