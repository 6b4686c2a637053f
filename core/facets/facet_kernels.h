#pragma once
#include <cstddef>

#include "core/base/numeric/simd_sets.h"

namespace dmise {

/// Arrays of a FacetSet, `count` a multiple of 8. `area_m2` may be the unobstructed area only.
struct FacetArrays {
  std::size_t count;
  const double *normal_x, *normal_y, *normal_z, *area_m2;
  const double *diffuse, *taken, *grazing2, *lobe2;
};

/// Unit vectors from the object.
struct FacetDirections {
  double sun[3], viewer[3];
  double inverse_half2;  // 1 / |sun + viewer|^2, capped
};

#define DMISE_FACET_KERNELS(level)                                         \
  namespace level {                                                        \
  /* Sum of area x f x cos in x cos out, without Phong's lobes [m2/sr]. */ \
  double facet_sum(const FacetArrays& facets, const FacetDirections& at);  \
  }
DMISE_EACH_SIMD_SET(DMISE_FACET_KERNELS)
#undef DMISE_FACET_KERNELS

}  // namespace dmise
