#pragma once
#include "core/orbit/attitude.h"

namespace dmise {

/// Attitude and its rate at one instant, as published per tick.
struct AttitudeState {
  Quaternion gcrs_from_body;  // unit, w >= 0
  Vec<Gcrs> rate_rad_per_s;   // angular velocity of the body, in GCRS axes
};

/// Attitude in the scene `now`; its rate is the difference between the scenes `before` and `after`,
/// a fraction of a second apart (less than half a turn). The rates of spinning and
/// tumbling bodies are the models', at any speed. Throws as `gcrs_from_body` does.
AttitudeState attitude_state(const Attitude& attitude, const AttitudeScene& before,
                             const AttitudeScene& now, const AttitudeScene& after);

/// Attitude at `u` in [0, 1] between two states `tick_s` apart: a cubic in the rotation that
/// remains after removing the first state's rate. Uniform rotation of many turns per tick is
/// reproduced exactly, attitude and rate are matched at both ends, and the error is of fourth order
/// in the tick.
Quaternion interpolate_attitude(double u, double tick_s, const AttitudeState& start,
                                const AttitudeState& end);

/// Greatest angle [rad] between a tumbling body and what is interpolated half way between ticks,
/// over `ticks` ticks that begin all over one period of its rate.
double worst_interpolation_rad(const TumblingAttitude& attitude, double tick_s, int ticks = 64);

}  // namespace dmise
