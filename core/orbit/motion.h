#pragma once
#include <cstdint>
#include <string_view>
#include <variant>

#include "core/frames/earth_orientation.h"
#include "core/orbit/oem.h"
#include "core/orbit/two_body.h"

namespace dmise {

/// Stays where it is relative to the axes of `F`.
template <class F>
struct ConstantPosition {
  Vec<F> position_m;
};

/// Moves on the conic through `state` at `epoch`.
struct TwoBodyMotion {
  Tai epoch;
  MotionState<Gcrs> state;
  double gm_m3_per_s2 = earth_gm_m3_per_s2;
};

/// How one object of a scenario moves. Element sets are propagated all at once by
/// core/orbit/sgp4_batch. To add a model: write its file pair, list it here, give it a `state_at`,
/// read it in core/config/motion_config.cpp, test it in tests/orbit.
using MotionModel =
    std::variant<ConstantPosition<Itrs>, ConstantPosition<Gcrs>, TwoBodyMotion, Trajectory>;

template <class F>
FramedState state_at(const ConstantPosition<F>& motion, const Tai&) {
  return MotionState<F>{motion.position_m, {}};
}
inline FramedState state_at(const TwoBodyMotion& motion, const Tai& time) {
  return propagate_two_body(motion.state, seconds_between(motion.epoch, time), motion.gm_m3_per_s2);
}

/// State at `time`. Throws `Error` where the model has none.
inline FramedState state_at(const MotionModel& motion, const Tai& time) {
  return std::visit([&](const auto& model) { return state_at(model, time); }, motion);
}

/// The same with the slope of the position for velocity.
inline FramedState path_at(const MotionModel& motion, const Tai& time) {
  const auto* trajectory = std::get_if<Trajectory>(&motion);
  return trajectory ? path_at(*trajectory, time) : state_at(motion, time);
}

/// Turns a state to GCRS at simulation time `t`, whose orientation of the Earth `earth` holds. The
/// velocity of a state in ITRS gets that of the turning Earth added.
MotionState<Gcrs> in_gcrs(const FramedState& state, const EarthOrientation& earth, SimTime t);

/// Why a motion model has no state at a time; beside the codes of SGP4, from which they differ.
enum class MotionCode : std::uint8_t {
  ok = 0,
  outside_span = 16,  // of a trajectory from a file
  underground = 17,   // the path leads into the Earth
};

/// "outside the span of its trajectory" and the like, for a log line.
std::string_view describe(MotionCode code);

}  // namespace dmise
