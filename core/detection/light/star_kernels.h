#pragma once
#include <cstddef>
#include <cstdint>

#include "core/base/numeric/simd_sets.h"

namespace dmise {

/// Rows of a star's image are whole numbers of as many values.
inline constexpr std::size_t star_lanes = 16;

/// One of the round Gaussians that a star's light is made of, in a box of pixels whose first one is
/// (0, 0). It has light in columns `left` to `right` and rows `top` to `bottom`.
struct StarPoint {
  float x_px = 0.0F, y_px = 0.0F;
  std::int32_t left = 0, right = 0, top = 0, bottom = 0;
};

/// What a star's image is drawn to: rows of `stride` values.
struct StarCanvas {
  std::size_t stride = 0, rows = 0;
  float* light = nullptr;
  float *by_x = nullptr, *by_y = nullptr;  // derivatives by the star's place; null: none
  float* scratch = nullptr;                // points * (stride + rows + star_lanes) values
};

/// Normal equations of a star's light, relative, and place.
struct StarSums {
  float right[3] = {};
  float matrix[6] = {};  // lower triangle by rows
  std::int32_t used = 0;
};

#define DMISE_STAR_KERNELS(level)                                                                \
  namespace level {                                                                              \
  /* Light `each` exp(curvature r^2) of all points. */                                           \
  void draw_points(const StarPoint* points, std::size_t count, float each, float curvature,      \
                   const StarCanvas& to);                                                        \
  /* Subtracts light [SNR] from the steps (FilteredFrame) that are not 0 and hides those with    \
     more than `hidden` of it; `odd`: whether the first pixel's column plus row is. */           \
  void subtract_light(const float* light, float hidden, std::size_t count, bool odd,             \
                      std::int8_t* steps);                                                       \
  /* Bits of up to 64 values that are above `least`. */                                          \
  std::uint64_t bits_above(const float* values, std::size_t count, float least);                 \
  /* Sums over rows of pixels, without those that are NaN. The weight of a pixel is              \
     1 / (1 + photons light + (model_error light)^2). */                                         \
  void add_pixels(const float* light, const float* by_x, const float* by_y, const float* pixels, \
                  std::size_t stride, std::size_t rows, float photons, float model_error,        \
                  StarSums& sums);                                                               \
  }
DMISE_EACH_SIMD_SET(DMISE_STAR_KERNELS)
#undef DMISE_STAR_KERNELS

}  // namespace dmise
