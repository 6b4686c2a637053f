#pragma once
#include <variant>

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
/// test it in tests/orbit.
using Motion =
    std::variant<ConstantPosition<Itrs>, ConstantPosition<Gcrs>, TwoBodyMotion, Trajectory>;

template <class F>
FramedState state_at(const ConstantPosition<F>& motion, const Tai&) {
  return MotionState<F>{motion.position_m, {}};
}
inline FramedState state_at(const TwoBodyMotion& motion, const Tai& time) {
  return propagate_two_body(motion.state, seconds_between(motion.epoch, time), motion.gm_m3_per_s2);
}

/// State at `time`. Throws `Error` where the model has none.
inline FramedState state_at(const Motion& motion, const Tai& time) {
  return std::visit([&](const auto& model) { return state_at(model, time); }, motion);
}

}  // namespace dmise
