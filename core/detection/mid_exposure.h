#pragma once
#include "core/products/frame_header.h"

namespace dmise {

/// Radial speed of a detected object, over its orbital speed: standard deviation (decision 0065).
inline constexpr double radial_speed_share = 0.02;

/// Where between the ends of its streak an object was at mid exposure. Even motion through space is
/// uneven on the sky: for an arc A seen at an angle a from the closest approach the object is
/// tan(a) A^2 / 4 past the middle, whatever its brightness did.
struct MidExposure {
  Vec<Gcrs> direction;     // unit; only its place along the streak counts
  double sigma_rad = 0.0;  // of that
};

/// `end1`, `end2`: as the WCS has them. From the ground tan(a) is that of the circular orbit
/// through both lines of sight, the mean of both ways of motion; `sigma_rad` is half of what these
/// differ by and what a radial speed changes. Without such an orbit, and in space: the middle, with
/// tan(a) = 1 as the standard deviation; half the arc where an end is cut off.
MidExposure mid_exposure(const FrameHeader& header, const Vec<Gcrs>& end1, const Vec<Gcrs>& end2,
                         bool at_edge);

}  // namespace dmise
