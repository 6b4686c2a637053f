#pragma once
#include <cstddef>

#include "core/base/numeric/simd_sets.h"

namespace dmise {

/// A place within a patch of a `StarPathGrid`: the number of its first node, and how far it is from
/// that in spacings, 0 to 2.
struct PatchPlace {
  std::size_t node;
  double u, v;
};

inline constexpr std::size_t path_values = 12;

#define DMISE_STAR_PATH_KERNELS(level)                                                            \
  namespace level {                                                                               \
  /* Interpolates nodes of `path_values` each, in rows of `across`, biquadratically at places. */ \
  void interpolate_paths(const double* nodes, std::size_t across, const PatchPlace* places,       \
                         std::size_t count, double* values);                                      \
  }
DMISE_EACH_SIMD_SET(DMISE_STAR_PATH_KERNELS)
#undef DMISE_STAR_PATH_KERNELS

}  // namespace dmise
