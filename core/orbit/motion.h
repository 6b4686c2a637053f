#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

#include "core/frames/earth_orientation.h"
#include "core/orbit/oem.h"
#include "core/orbit/two_body.h"

namespace dmise {

/// Fixed relative to the axes of `F`.
template <class F>
struct ConstantPosition {
  Vec<F> position_m;
};

/// Moves on the conic section through `state` at `epoch`.
struct TwoBodyMotion {
  Tai epoch;
  MotionState<Gcrs> state;
  double gm_m3_per_s2 = earth_gm_m3_per_s2;
};

/// Moves at a constant velocity, relative to the axes of `F`, through `state` at `epoch`.
template <class F>
struct StraightMotion {
  Tai epoch;
  MotionState<F> state;
};

/// Moves as a node of the scenario says, tick by tick. Nothing is known beforehand.
struct NodeMotion {
  std::string node;
  std::size_t place = 0;  // index among the objects of the node
};

/// Motion of one object of a scenario. Element sets are propagated in batches by
/// core/orbit/sgp4/sgp4_batch. To add a model: write its file pair, list it here, give it a
/// `state_at`, read it in core/config/objects/motion_config.cpp, test it in tests/orbit.
using MotionModel = std::variant<ConstantPosition<Itrs>, ConstantPosition<Gcrs>, TwoBodyMotion,
                                 Trajectory, StraightMotion<Itrs>, NodeMotion>;

template <class F>
FramedState state_at(const ConstantPosition<F>& motion, const Tai&) {
  return MotionState<F>{motion.position_m, {}};
}
inline FramedState state_at(const TwoBodyMotion& motion, const Tai& time) {
  return propagate_two_body(motion.state, seconds_between(motion.epoch, time), motion.gm_m3_per_s2);
}

template <class F>
FramedState state_at(const StraightMotion<F>& motion, const Tai& time) {
  const auto& [position_m, velocity_m_per_s] = motion.state;
  return MotionState<F>{position_m + velocity_m_per_s * seconds_between(motion.epoch, time),
                        velocity_m_per_s};
}

[[noreturn]] FramedState state_at(const NodeMotion& motion, const Tai& time);

/// State at `time`. Throws `Error` if the model has none.
inline FramedState state_at(const MotionModel& motion, const Tai& time) {
  return std::visit([&](const auto& model) { return state_at(model, time); }, motion);
}

/// State with the derivative of the position as velocity.
inline FramedState path_at(const MotionModel& motion, const Tai& time) {
  const auto* trajectory = std::get_if<Trajectory>(&motion);
  return trajectory ? path_at(*trajectory, time) : state_at(motion, time);
}

/// Rotates a state to GCRS at simulation time `t` with the Earth orientation `earth`. For a state
/// in ITRS the Earth's rotation is added to the velocity.
MotionState<Gcrs> in_gcrs(const FramedState& state, const EarthOrientation& earth, SimTime t);

/// Why a motion model has no state at a time; disjoint from the SGP4 codes.
enum class MotionCode : std::uint8_t {
  ok = 0,
  outside_span = 16,  // its trajectory from a file does not cover the time
  underground = 17,   // the path enters the Earth
  untold = 18,        // its node gives none
};

/// Text for a log line, such as "outside the span of its trajectory".
std::string_view describe(MotionCode code);

}  // namespace dmise
