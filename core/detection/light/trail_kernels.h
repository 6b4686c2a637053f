#pragma once
#include <cstddef>

#include "core/base/numeric/simd_sets.h"
#include "core/detection/light/trail_shape.h"

namespace dmise {

/// Pixels of a block: kernels take as many at once.
inline constexpr std::size_t trail_block = 64;

/// Normal equations of a block, and what it adds to the sums of a fit.
struct TrailSums {
  static constexpr std::size_t most = 16;

  double matrix[most][most] = {};  // lower triangle
  double right[most] = {};
  double chi2 = 0.0, merit = 0.0;  // merit: with the variances of the state before
};

/// A block of pixels. The last one may have fewer `used`; values behind are finite, variances 1.
struct TrailPixels {
  const double *x = nullptr, *y = nullptr, *signal_e = nullptr, *variance_e2 = nullptr;
  const double* before = nullptr;  // variance of the state before; null: its own
  std::size_t used = trail_block;
};

#define DMISE_TRAIL_KERNELS(level)                                                               \
  namespace level {                                                                              \
  /* Electrons of a trail in each pixel, added to `model`, and the seven derivatives by rows. */ \
  void trail_light(const TrailShape& trail, const NormalTable& normal, const double* x,          \
                   const double* y, double* model, double (*derivatives)[trail_block]);          \
  /* The same without derivatives. */                                                            \
  void trail_values(const TrailShape& trail, const NormalTable& normal, const double* x,         \
                    const double* y, double* model);                                             \
  /* out[i] = the normal distribution function at x[i]. */                                       \
  void normal_below_each(const NormalTable& normal, const double* x, std::size_t count,          \
                         double* out);                                                           \
  /* Adds a block. Weights are the inverse of variance + model + (model_error model)^2, which    \
     goes to `variance`. `gradients`: a row of `trail_block` values for each of n parameters. */ \
  void add_block(const TrailPixels& pixels, const double* model, double background_e,            \
                 double model_error, const double* const* gradients, std::size_t n,              \
                 double* variance, TrailSums& to);                                               \
  }
DMISE_EACH_SIMD_SET(DMISE_TRAIL_KERNELS)
#undef DMISE_TRAIL_KERNELS

}  // namespace dmise
