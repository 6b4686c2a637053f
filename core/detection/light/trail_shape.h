#pragma once
#include <cstddef>

// The light of a trail and its derivatives, for one pixel or for as many as a vector holds. Kernels
// include this: it has no functions that the linker could share.
namespace dmise {

/// A trail prepared for evaluation: a line convolved with concentric Gaussians.
struct TrailShape {
  static constexpr std::size_t max_parts = 8;

  double x_px = 0.0, y_px = 0.0, flux_e = 0.0, length_px = 0.0, slope = 0.0, sagitta_px = 0.0;
  double cos_angle = 1.0, sin_angle = 0.0;
  bool is_point = false;
  // Factors of derivatives along and across in the term of the pixel's square.
  double fourth = 0.0, mixed = 0.0, odd = 0.0;
  std::size_t parts = 0;
  // For each part: inverse of sigma along the line at a place across it, and across; how far the
  // middle of its light along the line moves with the place across; whether it has that term.
  double weight[max_parts] = {}, along[max_parts] = {}, across[max_parts] = {},
         lean[max_parts] = {};
  bool is_narrow[max_parts] = {};
};

/// Normal distribution function and density in steps of 1/64 from -7 to 7; beyond, 0 or 1 and 0.
/// Taylor's series to third order from the nearest gives 1e-10.
struct NormalTable {
  static constexpr double reach = 7.0, step = 1.0 / 64;
  static constexpr int half = 448;  // reach / step

  double cdf[2 * half + 1], pdf[2 * half + 1];
};

}  // namespace dmise
