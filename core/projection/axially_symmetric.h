#pragma once
#include <array>
#include <cmath>
#include <optional>

#include "core/projection/coefficient.h"

namespace dmise {

/// Base of projections whose image height r(theta) is the same all around the axis. `Lens` has
///   height(theta_rad)      image height r in focal lengths
///   theta_rad(height)      its inverse; nothing beyond the projection
///   per_sine(x, y, z)      r / sin(theta) of a unit vector; nothing where it has no image
///   area_scale(theta_rad)  solid angle [sr] of a unit of image area
template <class Lens>
struct AxiallySymmetric {
  std::optional<double> axis_angle_rad(double x, double y) const {
    return lens().theta_rad(std::hypot(x, y));
  }
  std::optional<std::array<double, 3>> direction_of(double x, double y) const {
    const double height = std::hypot(x, y);
    const auto angle = lens().theta_rad(height);
    if (!angle) return std::nullopt;
    const double s = height > 0.0 ? std::sin(*angle) / height : 1.0;
    return std::array{s * x, s * y, std::cos(*angle)};
  }
  std::optional<std::array<double, 2>> image_of(double x, double y, double z) const {
    const std::optional<double> scale = lens().per_sine(x, y, z);
    if (!scale || !(z > -1.0 + 1e-15) || !std::isfinite(*scale)) return std::nullopt;
    return std::array{*scale * x, *scale * y};
  }
  double pixel_solid_angle_sr(double x_px, double y_px, double focal_length_px) const {
    const auto theta_rad = lens().theta_rad(std::hypot(x_px, y_px) / focal_length_px);
    if (!theta_rad) return 0.0;
    const double centre_sr = 1.0 / (focal_length_px * focal_length_px);
    return centre_sr * lens().area_scale(*theta_rad);
  }
  bool operator==(const AxiallySymmetric&) const = default;

 private:
  const Lens& lens() const { return static_cast<const Lens&>(*this); }
};

}  // namespace dmise
