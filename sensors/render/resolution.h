#pragma once

namespace dmise {

/// Whether an object of `radius_m` about its origin has a shape for a camera: drawn as a point it
/// would be misplaced or widened by up to its angular radius, which is to be at most `error_px`
/// pixels.
constexpr bool is_resolved(double radius_m, double range_m, double pixel_rad, double error_px) {
  return radius_m > error_px * pixel_rad * range_m;
}

}  // namespace dmise
