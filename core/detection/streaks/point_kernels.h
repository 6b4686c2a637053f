#pragma once
#include <cstddef>

#include "core/base/numeric/simd_sets.h"

namespace dmise {

/// Points of a block: kernels take as many at once.
inline constexpr std::size_t point_block = 64;

/// Points by coordinates, in whole blocks. The last one is filled with points of weight 0.
struct WeighedPoints {
  const double *x = nullptr, *y = nullptr, *weight = nullptr;
  const double* after = nullptr;  // for each block, the weights from it on; 0 behind the last
  std::size_t blocks = 0;
};

/// A line through a point with a direction of length 1.
struct PointLine {
  double x = 0.0, y = 0.0, ux = 1.0, uy = 0.0;
};

#define DMISE_POINT_KERNELS(level)                                                            \
  namespace level {                                                                           \
  /* The weight of the points within `width` of a line; may be less where it is not more than \
     `most`. */                                                                               \
  double weight_within(const WeighedPoints& points, const PointLine& line, double width,      \
                       double most);                                                          \
  }
DMISE_EACH_SIMD_SET(DMISE_POINT_KERNELS)
#undef DMISE_POINT_KERNELS

}  // namespace dmise
