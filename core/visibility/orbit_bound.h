#pragma once
#include "core/frames/vec.h"

namespace dmise {

/// How fast and how far an object can be within an hour of a state, from its osculating ellipse.
struct OrbitBound {
  double speed_m_per_s = 0.0;          // never faster, in TEME
  double turning_speed_m_per_s = 0.0;  // never faster, in axes that turn with the Earth
  double distance_m = 0.0;             // never farther from the Earth's centre
};

/// With margins for what the osculating ellipse changes over an hour: 1.5 % of the speed at perigee
/// and 10 m/s, 3 % of the apogee (docs/models/visibility.md). Infinite for an orbit that is no
/// ellipse.
OrbitBound orbit_bound(const Vec<Teme>& position_m, const Vec<Teme>& velocity_m_per_s);

/// The greater of each.
OrbitBound either(const OrbitBound& a, const OrbitBound& b);

}  // namespace dmise
