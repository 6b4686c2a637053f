#pragma once
#include <cstddef>
#include <cstdint>

#include "core/base/numeric/simd_sets.h"

namespace dmise {

struct PreparedCone {
  double apex[3];
  double axis[3];  // divided by the cosine of the half angle
  bool wide;       // more than 90 degrees: axis and angle are those of the opposite cone
};

/// Tests `words` times 64 objects; coordinates are aligned to 64 bytes.
struct ConeKernels {
  /// Which objects are not at the origin.
  void (*present)(const double* x, const double* y, const double* z, std::size_t words,
                  std::uint64_t* present);
  /// Which of those that `present` marks are in one cone.
  void (*inside)(const double* x, const double* y, const double* z, std::size_t words,
                 const PreparedCone& cone, const std::uint64_t* present, std::uint64_t* inside);
};

#define DMISE_CONE_KERNELS(level)        \
  namespace level {                      \
  extern const ConeKernels cone_kernels; \
  }
DMISE_EACH_SIMD_SET(DMISE_CONE_KERNELS)
#undef DMISE_CONE_KERNELS

}  // namespace dmise
