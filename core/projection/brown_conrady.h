#pragma once
#include <array>
#include <optional>
#include <span>

#include "core/base/units.h"
#include "core/projection/coefficient.h"

namespace dmise {

/// A gnomonic lens with radial and tangential distortion, OpenCV's model: with x, y the gnomonic
/// place in focal lengths, r^2 = x^2 + y^2 and R = 1 + k1 r^2 + k2 r^4 + k3 r^6
///   x' = x R + 2 p1 x y + p2 (r^2 + 2 x^2),  y' = y R + p1 (r^2 + 2 y^2) + 2 p2 x y.
/// This is the gradient of a potential, so one to one on any disc where its matrix of derivatives
/// is positive definite. What lies beyond the largest such disc has no image. Source: Brown 1966,
/// Photogrammetric Engineering 32, 444.
class BrownConrady {
 public:
  static constexpr const char *name = "brown_conrady", *fits_code = nullptr;
  static constexpr double widest_field_rad = 170 * deg;
  static constexpr std::array<ProjectionCoefficient, 5> coefficients{{
      {.key = "k1", .card = "LENSK1", .most = 1e4, .comment = "radial, of r^3"},
      {.key = "k2", .card = "LENSK2", .most = 1e4, .comment = "radial, of r^5"},
      {.key = "k3", .card = "LENSK3", .most = 1e4, .comment = "radial, of r^7"},
      {.key = "p1", .card = "LENSP1", .most = 1e2, .comment = "tangential"},
      {.key = "p2", .card = "LENSP2", .most = 1e2, .comment = "tangential"},
  }};

  explicit BrownConrady(const std::array<double, 5>& values);

  std::span<const double> values() const { return c_; }
  double rim() const;
  std::optional<double> fold_rad() const;
  double height(double theta_rad) const;
  std::optional<double> axis_angle_rad(double x, double y) const;
  std::optional<std::array<double, 3>> direction_of(double x, double y) const;
  std::optional<std::array<double, 2>> image_of(double x, double y, double z) const;
  double pixel_solid_angle_sr(double x_px, double y_px, double focal_length_px) const;
  bool operator==(const BrownConrady& other) const { return c_ == other.c_; }

 private:
  struct Place {
    double x, y;
  };
  /// A distorted place and its derivatives by the gnomonic one, a symmetric matrix.
  struct Distorted {
    double x, y, xx, xy, yy;
  };
  Distorted distort(Place gnomonic) const;
  std::optional<Place> undistort(Place distorted) const;

  std::array<double, 5> c_;
  double limit_;  // radius of the disc; infinite if the mapping never folds
};

}  // namespace dmise
