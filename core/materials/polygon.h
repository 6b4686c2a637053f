#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "core/orbit/attitude.h"

namespace dmise {

/// Cuts a face of n corners, convex or not, into n - 2 triangles of its corners' numbers (0..n-1)
/// that keep its sense of turning: ears, on the plane that it faces most. A face that crosses
/// itself is cut in a fan. Quadratic in n.
std::vector<std::array<std::uint32_t, 3>> triangulate(const std::vector<Vec<Body>>& corners);

}  // namespace dmise
