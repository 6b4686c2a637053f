#pragma once
#include <array>
#include <cstddef>
#include <vector>

#include "core/base/pixel.h"
#include "core/sequences/filtered_sequence.h"
#include "core/sequences/registration.h"

namespace dmise {

/// Farther from a frame nothing is searched for [px].
inline constexpr double max_away_px = 1e6;

/// A nearly even motion over the sky, in pixels of the reference frame.
struct SkyMotion {
  PixelPosition place;         // at the middle of the reference frame's exposure
  PixelPosition rate;          // [px/s]
  PixelPosition acceleration;  // [px/s2]

  PixelPosition at(double time_s) const {
    return place + rate * time_s + acceleration * (time_s * time_s / 2);
  }
};

/// Motions that are searched for: rates within a circle, faster than stars.
struct MotionRange {
  PixelPosition middle;       // motion of the detector over the sky, where it is even [px/s]
  double max_px_per_s = 0.0;  // against the middle
  double min_px_per_s = 0.0;  // against the stars
  double scale_rad_per_px = 0.0;

  bool has(PixelPosition rate) const;
  /// Standard deviation of the acceleration of an object that moves evenly [px/s2]: its path is
  /// bent in the image as a circle around the pole is, 45 deg away, or as its orbit.
  double acceleration_px_per_s2(PixelPosition rate) const;
};

/// `scale_rad_per_px`: of the frames. `max_px_per_s`: 0 for that at which a point trails by two
/// widths (FWHM) of the PSF over the detector in an exposure. What moves by less than two widths
/// over the sequence is a star.
MotionRange motion_range(const FilteredSequence& sequence, const Registration& registration,
                         double scale_rad_per_px, double max_px_per_s);

}  // namespace dmise
