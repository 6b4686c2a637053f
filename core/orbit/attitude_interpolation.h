#pragma once
#include "core/orbit/attitude.h"

namespace dmise {

/// Attitude and its rate at one instant: what travels per tick.
struct AttitudeState {
  Quaternion gcrs_from_body;  // unit, w >= 0
  Vec<Gcrs> rate_rad_per_s;   // angular velocity of the body, in GCRS axes
};

/// The attitude in the scene `now`, its rate from the difference between the scenes `before` and
/// `after`, whose times embrace it (a fraction of a second apart: less than half a turn). The rate
/// of a spinning body is the model's own, however fast. Throws as `gcrs_from_body`.
AttitudeState attitude_state(const Attitude& attitude, const AttitudeScene& before,
                             const AttitudeScene& now, const AttitudeScene& after);

/// Attitude at `u` in [0, 1] between two states `tick_s` apart: a cubic in the turn that is left
/// over when the first state's rate is taken out, so that a body that turns evenly, many times a
/// tick, is met exactly; attitude and rate are met at both ends. Falls with the fourth power of the
/// tick for what turns smoothly.
Quaternion interpolate_attitude(double u, double tick_s, const AttitudeState& start,
                                const AttitudeState& end);

}  // namespace dmise
