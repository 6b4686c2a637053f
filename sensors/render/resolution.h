#pragma once

namespace dmise {

/// Whether an object of `radius_m` about its origin is resolved by a camera: drawn as a point, it
/// would be displaced or broadened by up to its angular radius, which may be at most `error_px`
/// pixels.
constexpr bool is_resolved(double radius_m, double range_m, double pixel_rad, double error_px) {
  return radius_m > error_px * pixel_rad * range_m;
}

}  // namespace dmise
