#pragma once
#include "core/orbit/motion_state.h"

namespace dmise {

/// Geocentric gravitational constant [m^3/s^2]: IERS Conventions 2010, table 1.1 (TT-compatible).
inline constexpr double earth_gm_m3_per_s2 = 3.986004415e14;

using TwoBodyState = MotionState<Gcrs>;

/// Osculating elements of an ellipse, or of a parabola or hyperbola for `eccentricity` >= 1.
struct KeplerElements {
  double periapsis_m = 0.0;   // distance of the periapsis from the Earth's centre, > 0
  double eccentricity = 0.0;  // >= 0
  double inclination_rad = 0.0;
  double raan_rad = 0.0;
  double argument_of_perigee_rad = 0.0;
  double true_anomaly_rad = 0.0;  // < acos(-1/e) off the periapsis for e >= 1
};

/// State of the elements in GCRS. Throws `Error` naming an element that is out of range.
TwoBodyState state_of(const KeplerElements& elements, double gm_m3_per_s2 = earth_gm_m3_per_s2);

/// State `dt_s` later (or earlier, < 0) on the conic through `start`: circular, elliptic,
/// parabolic, hyperbolic or radial (through the centre and back on the same line). Energy and
/// angular momentum are conserved to 1e-12 of v^2/2 + gm/r after 1e5 turns. Throws `Error` for a
/// state at the centre or not finite, and if the result is the centre itself.
TwoBodyState propagate_two_body(const TwoBodyState& start, double dt_s,
                                double gm_m3_per_s2 = earth_gm_m3_per_s2);

}  // namespace dmise
