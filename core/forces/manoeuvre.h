#pragma once
#include "core/frames/vec.h"
#include "core/orbit/motion_state.h"

namespace dmise {

/// Axes of an orbit: radial (away from the Earth's centre), transverse (in the plane, forwards) and
/// normal (along the angular momentum).
struct Rtn {};

/// A change of velocity at once, or a burn of constant thrust.
struct Manoeuvre {
  double at_s = 0.0;                // simulation time of it, or of its start
  Vec<Rtn> delta_v_m_per_s;         // a change at once
  double duration_s = 0.0;          // a burn lasts so long; 0: a change at once
  double thrust_n = 0.0;            // >= 0
  double mass_kg = 0.0;             // at its start, > 0
  Vec<Rtn> direction;               // unit, along the acceleration; it turns with the axes
  double specific_impulse_s = 0.0;  // 0: the mass does not change

  double end_s() const { return at_s + duration_s; }
  bool operator==(const Manoeuvre&) const = default;
};

/// Acceleration of an object by a burn that lasts at `time_s` [m/s^2].
double burn_m_per_s2(const Manoeuvre& burn, double time_s);

/// Mass that a burn leaves [kg]; not above 0 if it takes more than there is.
double mass_left_kg(const Manoeuvre& burn, double time_s);

/// Rotates a vector from the axes of an orbit. Motion along a radius has no plane: any is taken.
Vec<Gcrs> gcrs_from_rtn(const MotionState<Gcrs>& state, const Vec<Rtn>& v);

}  // namespace dmise
