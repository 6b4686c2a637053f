#pragma once
#include <cstddef>

#include "core/base/numeric/simd_sets.h"

namespace dmise {

/// What moves stars between a catalogue and an observer: years from the catalogue's epoch, and the
/// observer's position from the barycentre in light years and in au.
struct CatalogueMotion {
  double years = 0.0, light_years[3] = {}, au[3] = {};
  double moves = 0.0;  // 1 with proper motion, else 0
};

/// Places of stars, unit vectors, and their motions and parallaxes: arrays of one size.
struct StarArrays {
  double *x, *y, *z;
  const double *pm_ra_cosdec_rad_per_yr, *pm_dec_rad_per_yr, *parallax_rad;
};

#define DMISE_STAR_PLACE_KERNELS(level)                                                       \
  namespace level {                                                                           \
  /* Moves stars that are not at a pole; `count` is a multiple of 8. */                       \
  void move_stars(const CatalogueMotion& motion, const StarArrays& stars, std::size_t count); \
  }
DMISE_EACH_SIMD_SET(DMISE_STAR_PLACE_KERNELS)
#undef DMISE_STAR_PLACE_KERNELS

}  // namespace dmise
