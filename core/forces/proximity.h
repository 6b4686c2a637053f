#pragma once
#include <variant>
#include <vector>

#include "core/forces/manoeuvre.h"
#include "core/frames/vec.h"
#include "core/orbit/motion_state.h"
#include "core/orbit/two_body.h"

namespace dmise {

/// State of a deputy relative to its chief in the chief's radial, transverse and normal axes. The
/// velocity is that seen in the axes, which turn with the chief.
struct RelativeState {
  Vec<Rtn> position_m, velocity_m_per_s;
};

/// Relative state `dt_s` later about a chief on a circle with mean motion `n_rad_per_s` > 0, to
/// first order in the distance over the radius. Source: Clohessy & Wiltshire 1960, Journal of the
/// Aerospace Sciences 27, 653.
RelativeState clohessy_wiltshire(const RelativeState& start, double n_rad_per_s, double dt_s);

/// State of a deputy in GCRS, and what it is relative to the chief.
MotionState<Gcrs> deputy_state(const MotionState<Gcrs>& chief, const RelativeState& relative);
RelativeState relative_state(const MotionState<Gcrs>& chief, const MotionState<Gcrs>& deputy);

enum class RelativeDynamics { two_body, clohessy_wiltshire };

/// Free motion from a state at time 0. By two bodies it is the difference of two conics, that of
/// the chief through its state at time 0, in the axes of that conic; any distance and eccentricity.
struct NaturalMotion {
  RelativeState start;
  RelativeDynamics dynamics = RelativeDynamics::two_body;
};

/// The closed solution of Clohessy and Wiltshire: an ellipse twice as long along the orbit as it is
/// high, once round in a revolution. Radial: b sin(nt + phase), transverse: centre + 2 b cos(nt +
/// phase), normal: c sin(nt + normal phase).
struct Circumnavigation {
  double radial_m = 0.0, normal_m = 0.0;  // semi-axes, >= 0, not both 0
  double phase_rad = 0.0, normal_phase_rad = 0.0;
  double centre_transverse_m = 0.0;
};

/// Holds a place in the axes until `at_s`, moves to another on a straight line, and holds that. It
/// does so by construction: thrusters that nothing models balance gravity.
struct ForcedApproach {
  Vec<Rtn> from_m, to_m;
  double speed_m_per_s = 1.0;  // > 0
  double at_s = 0.0;           // since time 0

  double end_s() const { return at_s + norm(to_m - from_m) / speed_m_per_s; }
};

/// Motion of a deputy. To add one: its struct here, `position_m` and `corners_s`, keys in
/// core/config/objects/proximity_config.cpp.
using ProximityMotion = std::variant<NaturalMotion, Circumnavigation, ForcedApproach>;

/// Place of a deputy in the chief's axes at `time_s`; `chief_0` is the chief's state at time 0.
/// Throws `Error` for a chief without an orbit.
Vec<Rtn> position_m(const ProximityMotion& motion, const MotionState<Gcrs>& chief_0, double time_s,
                    double gm_m3_per_s2 = earth_gm_m3_per_s2);

/// Times at which the relative velocity changes at once, in order.
std::vector<double> corners_s(const ProximityMotion& motion);

/// Whether the motion is a solution for a circular chief alone.
bool needs_circular_chief(const ProximityMotion& motion);

/// Eccentricity of the conic through a state.
double eccentricity_of(const MotionState<Gcrs>& state, double gm_m3_per_s2 = earth_gm_m3_per_s2);

}  // namespace dmise
