#pragma once
#include <cstddef>
#include <optional>
#include <span>

#include "core/camera_calibration/detector/jackknife.h"

namespace dmise {

/// The zero point that one star shows.
struct StarZeroPoint {
  double mag = 0.0, sigma_mag = 0.0;
  double bv = 0.0;  // colour of the star
  std::size_t frame = 0;
};

/// Zero point for a star of the Sun's colour, by a line over colour where the stars show one.
/// Its deviation is by the stars' scatter or by leaving out a part of them at a time, whichever is
/// greater, and widened where frames differ by more than their stars. Empty if there are fewer than
/// five.
std::optional<MeasuredValue> joint_zero_point(std::span<const StarZeroPoint> stars);

}  // namespace dmise
