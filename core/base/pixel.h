#pragma once

namespace dmise {

/// A place in an image: (0, 0) is the centre of the first pixel, x along columns, y along rows
/// (down).
struct PixelPosition {
  double x_px = 0.0, y_px = 0.0;

  PixelPosition operator+(const PixelPosition& b) const { return {x_px + b.x_px, y_px + b.y_px}; }
  PixelPosition operator-(const PixelPosition& b) const { return {x_px - b.x_px, y_px - b.y_px}; }
  PixelPosition operator*(double s) const { return {x_px * s, y_px * s}; }
  bool operator==(const PixelPosition&) const = default;
};

}  // namespace dmise
