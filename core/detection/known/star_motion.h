#pragma once
#include <array>
#include <optional>

#include "core/base/pixel.h"
#include "core/products/frame_header.h"

namespace dmise {

/// Motion of the star field over the detector during the exposure, from the header's attitudes and
/// projection. Distortion and differential refraction are neglected: they change a trail by parts
/// per thousand.
class StarMotion {
 public:
  StarMotion(const FrameHeader& header, int columns, int rows);

  /// Displacement [px] from start to end of the exposure of the star at `pixel` in its middle; zero
  /// where the projection has no image.
  PixelPosition trail_at(PixelPosition pixel) const;

  /// Trails in the frame's middle, at its corners and in the middles of its edges.
  std::array<PixelPosition, 9> trails_over_frame() const;
  /// Length of the longest of these.
  double longest_trail_px() const;

 private:
  std::optional<Vec<CameraFrame>> direction(PixelPosition pixel) const;
  std::optional<PixelPosition> pixel(const Vec<CameraFrame>& direction) const;

  Projection projection_;
  double focal_length_px_;
  PixelPosition centre_;
  double down_;  // 1 if rows run along the camera's y axis, else -1
  Rotation<CameraFrame, CameraFrame> start_from_middle_, end_from_middle_;
};

/// Sets a header's attitudes so that stars trail by so much in the frame's middle, at an even rate.
/// Which end was first is not known: the trail's sign is taken as it is.
void set_even_drift(FrameHeader& header, PixelPosition trail);

}  // namespace dmise
