#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/numeric/simd_level.h"
#include "core/base/parallel.h"
#include "core/frames/vec.h"

namespace dmise {

/// Field of view of a sensor at one tick: directions within `half_angle_rad` of `axis` from
/// `apex_m`, in the frame of the object positions.
struct Cone {
  Vec<Teme> apex_m;
  Vec<Teme> axis;             // unit vector: boresight, or the zenith for "above an elevation"
  double half_angle_rad = 0;  // (0, pi]
};

/// 64-bit words of one cone's row of bits over `objects` objects.
inline std::size_t cone_words(std::size_t objects) { return (objects + 63) / 64; }

/// Finds which objects lie in which cones. `position_m` holds 3 n values: all x, all y, all z.
/// `inside` holds cones.size() rows of cone_words(n) words; bit i % 64 of word i / 64 of row s is
/// set if object i lies in cone s (edge included), bits beyond n are 0. An object at the Earth's
/// centre, which marks a missing state, or at the apex is in no cone. Throws `Error` on a wrong
/// size. Instruction sets give the same bits except within 1e-12 rad of the edge.
void cone_test(std::span<const double> position_m, std::span<const Cone> cones,
               std::span<std::uint64_t> inside, Threads* threads = nullptr,
               SimdLevel simd = best_simd_level());

}  // namespace dmise
