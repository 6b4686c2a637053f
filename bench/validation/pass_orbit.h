#pragma once
#include <span>
#include <vector>

#include "core/frames/earth_orientation.h"
#include "core/orbit/motion_state.h"

namespace dmise {

/// What a light curve says of where its satellite was.
struct RangePhase {
  double time_s = 0.0;  // from any instant
  double range_m = 0.0;
  double phase_rad = 0.0;  // Sun, satellite, observer
  Vec<Cirs> observer_m;
};

/// A pass on a circular orbit, in the axes of date.
struct CircularPass {
  double inclination_rad = 0.0;
  double raan_rad = 0.0, argument_rad = 0.0;  // argument of latitude at time 0
  double radius_m = 0.0;
  double rms_m = 0.0;  // misfit of the ranges that it was fitted to

  MotionState<Cirs> at(double time_s) const;
};

/// Returns the circular orbit of the stated inclination whose ranges and phases are nearest to
/// those observed: to 1 km and 0.05 deg each. `height_m`: about, over a sphere. Throws `Error` if
/// none is within `worst_rms_m`.
CircularPass fit_circular_pass(std::span<const RangePhase> seen, const Vec<Cirs>& to_sun,
                               double inclination_rad, double height_m, double worst_rms_m = 5e3);

}  // namespace dmise
