#pragma once
#include <array>
#include <optional>
#include <vector>

#include "core/base/pixel.h"
#include "core/frames/vec.h"
#include "core/projection/projection.h"

namespace dmise {

/// Terms of a distortion up to an order: the moves of a pixel [px] by one unit of each coefficient.
/// Two of the first order (aspect and skew; scale and roll are the camera's), then U^p V^q along x
/// and along y for each 2 <= p + q <= order.
int distortion_size(int order);
void distortion_terms(int order, double u, double v, std::vector<PixelPosition>& moves);

/// Where a camera points and how it images apparent directions: pixel - centre + distortion =
/// focal length times the projection. `camera_from_gcrs` has determinant -1 if the image is
/// mirrored.
struct PlateModel {
  Projection projection;
  Rotation<CameraFrame, Gcrs> camera_from_gcrs;
  double focal_length_px = 0.0;
  PixelPosition centre;            // pixel on the axis
  int order = 0;                   // order of the distortion
  double unit_px = 1.0;            // U and V are (pixel - centre) / unit_px
  std::vector<double> distortion;  // [px], `distortion_size(order)` coefficients

  bool mirrored() const;
  Vec<Gcrs> axis() const;
  /// Undistorted place of a pixel [px from the axis].
  PixelPosition undistorted(PixelPosition pixel) const;
  /// Undistorted place of an apparent direction (unit); empty where it has no image.
  std::optional<PixelPosition> focal_place(const Vec<CameraFrame>& direction) const;
  std::optional<PixelPosition> focal_place(const Vec<Gcrs>& direction) const {
    return focal_place(camera_from_gcrs * direction);
  }
  /// Pixel of an apparent direction (unit); empty where it has none or where the distortion has no
  /// inverse.
  std::optional<PixelPosition> pixel(const Vec<Gcrs>& direction) const;
  /// Apparent direction of a pixel; empty where none is imaged.
  std::optional<Vec<Gcrs>> direction(PixelPosition pixel) const;
};

/// `rotation` turned by a small rotation vector [rad] on the camera's axes.
Rotation<CameraFrame, Gcrs> turned(const Rotation<CameraFrame, Gcrs>& rotation,
                                   const Vec<CameraFrame>& by_rad);

/// The rotation that brings `first` onto the image `u` and `second` into the plane of `u` and `v`.
Rotation<CameraFrame, Gcrs> triad(const Vec<CameraFrame>& u, const Vec<CameraFrame>& v,
                                  const Vec<Gcrs>& first, const Vec<Gcrs>& second);

/// `rotation` with the image's rows in the opposite order.
Rotation<CameraFrame, Gcrs> flipped(Rotation<CameraFrame, Gcrs> rotation);

}  // namespace dmise
