#pragma once
#include "core/products/frame_header.h"

namespace dmise {

/// Standard deviation of a detected object's radial speed, relative to its orbital speed (decision
/// 0065).
inline constexpr double radial_speed_share = 0.02;

/// Position of an object at mid exposure along its streak. Uniform motion in space is not uniform
/// on the sky: for an arc A seen at an angle a from the closest approach the object is tan(a) A^2 /
/// 4 past the middle, whatever its brightness.
struct MidExposure {
  Vec<Gcrs> direction;     // unit; only its component along the streak matters
  double sigma_rad = 0.0;  // along the streak
  // Distance at end1 over that at end2, of that orbit; 1 where there is none.
  double end1_range_over_end2 = 1.0;
};

/// `end1`, `end2`: directions from the WCS. From the ground tan(a) is that of the circular orbit
/// through both lines of sight, the mean over both directions of motion; `sigma_rad` combines half
/// their difference and the effect of a radial speed. Without such an orbit, and in space: the
/// middle, with tan(a) = 1 as the standard deviation; half the arc if an end is cut off.
MidExposure mid_exposure(const FrameHeader& header, const Vec<Gcrs>& end1, const Vec<Gcrs>& end2,
                         bool at_edge);

}  // namespace dmise
