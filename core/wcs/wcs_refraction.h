#pragma once
#include <vector>

#include "core/base/pixel.h"
#include "core/sky/air/refraction.h"
#include "core/wcs/wcs.h"

// Refraction in a world coordinate system. In FITS it is a distortion by table lookup (CPDISj =
// 'LOOKUP', Calabretta et al. 2004, "Representations of distortions in FITS world coordinate
// systems", section 3.2), which astropy reads: added to pixel coordinates as SIP polynomials are.
namespace dmise {

/// Shifts pixels by the refraction of a `Wcs`; throws `Error` if it has none.
class RefractionShift {
 public:
  explicit RefractionShift(const Wcs& wcs);

  /// Shift of a pixel; 0 where no direction is imaged. Below the horizon the refraction at the
  /// horizon.
  PixelPosition at(PixelPosition pixel) const { return shift(pixel, false); }
  /// Shift with refraction extended smoothly below the horizon, for nodes of a table.
  PixelPosition smooth_at(PixelPosition pixel) const { return shift(pixel, true); }
  /// Apparent elevation [rad]; -pi/2 where no direction is imaged.
  double elevation_rad(PixelPosition pixel) const;

 private:
  PixelPosition shift(PixelPosition pixel, bool smooth) const;

  Projection lens_;
  PixelPosition principal_point_, offset_px_;
  double focal_length_px_;
  Vec<CameraFrame> zenith_;
  Refraction refraction_;
  double at_horizon_rad_, slope_at_horizon_;
};

/// A distortion sampled over an image: node (i, j) is at pixel (first_px + i cell_px, first_px + j
/// cell_px), with bilinear interpolation.
struct ShiftTable {
  static constexpr double first_px = -1.0;
  int columns = 0, rows = 0;
  double cell_px = 0.0;
  std::vector<float> x_px, y_px;  // row by row
};

/// Number of nodes that span an image side of `pixels`.
int shift_table_nodes(int pixels, double cell_px);
/// `wcs` must have refraction; `columns` and `rows` of the image.
ShiftTable shift_table(const Wcs& wcs, int columns, int rows);

}  // namespace dmise
