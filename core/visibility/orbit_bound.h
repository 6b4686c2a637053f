#pragma once
#include "core/frames/vec.h"

namespace dmise {

/// Bounds on the motion of an object within an hour of a state, from its osculating ellipse.
struct OrbitBound {
  double speed_m_per_s = 0.0;          // upper bound, in TEME
  double turning_speed_m_per_s = 0.0;  // upper bound, in axes that rotate with the Earth
  double distance_m = 0.0;             // upper bound, from the Earth's centre
};

/// Includes margins for changes of the osculating ellipse over an hour: 1.5 % of the speed at
/// perigee and 10 m/s, 3 % of the apogee (docs/models/visibility.md). Infinite for an orbit that is
/// not an ellipse.
OrbitBound orbit_bound(const Vec<Teme>& position_m, const Vec<Teme>& velocity_m_per_s);

/// The maximum of each.
OrbitBound either(const OrbitBound& a, const OrbitBound& b);

}  // namespace dmise
