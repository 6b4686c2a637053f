#pragma once
#include <array>

#include "core/base/pixel.h"
#include "core/products/truth.h"

namespace dmise {

/// The path of a source over the detector: the parabola in time through its places at the start,
/// the middle and the end of the exposure, and its tangents beyond. A point if all are equal.
class TrueTrail {
 public:
  TrueTrail(PixelPosition start, PixelPosition middle, PixelPosition end);

  /// Place on the trail; `u`: fraction of the exposure, outside 0..1 on the tangents.
  PixelPosition at(double u) const;
  /// Unit vector along the trail; (1, 0) for a point.
  PixelPosition direction(double u) const;

  struct Nearest {
    double u = 0.5;
    double along_px = 0.0;     // arc length from the start
    double across_px = 0.0;    // signed: positive to the right, with y down
    double distance_px = 0.0;  // from the part with u in 0..1
  };
  Nearest nearest(PixelPosition place) const;
  /// Quick test: false only if the part with u in 0..1 is not within that distance.
  bool may_be_near(PixelPosition place, double distance_px) const;

  double length_px() const { return arc_px_.back(); }
  /// Length of the part inside a frame.
  double length_inside_px(int columns, int rows) const;

 private:
  static constexpr int pieces = 64;
  PixelPosition velocity(double u) const;  // [px per exposure]
  double arc_px(double u) const;
  PixelPosition start_, slope_, bend_;              // start + slope u + bend u^2
  std::array<PixelPosition, pieces + 1> places_{};  // at equal steps of u
  std::array<double, pieces + 1> arc_px_{};
  PixelPosition least_, most_;  // corners of a box around it
};

/// Returns the places of an object at the start, the middle and the end of the exposure. Places
/// that the camera does not image are extrapolated evenly.
std::array<PixelPosition, 3> places_of(const Truth& truth);

/// Whether a place is on a pixel of the frame.
bool is_inside(PixelPosition place, int columns, int rows);

}  // namespace dmise
