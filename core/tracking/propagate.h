#pragma once
#include <span>

#include "core/forces/forces.h"
#include "core/tracking/orbit_state.h"
#include "core/tracking/outcome.h"

namespace dmise {

/// Dormand-Prince 5(4) with steps by the estimated error of each.
struct PropagationSettings {
  double position_tolerance_m = 1e-5;  // error of one step, > 0
  int max_steps = 200000;
};

/// The state at `to`, earlier or later. Error against the forces' exact solution: below 0.1 m
/// after a day near the Earth with the default tolerance. Refuses a state that is not sane, a path
/// that enters the Earth (below 6,356 km from the centre) and more than `max_steps` steps.
Outcome<OrbitState> propagate(const ForceModel& forces, const OrbitState& state, SimTime to,
                              const PropagationSettings& settings = {});

/// A state with its derivatives with respect to the starting state.
struct StateTransition {
  OrbitState state;
  OrbitMatrix transition = OrbitMatrix::Identity();  // d state(to) / d state(from)
};

/// Propagates with the state transition matrix: derivatives of the integrated path itself, exact to
/// rounding.
Outcome<StateTransition> propagate_with_transition(const ForceModel& forces,
                                                   const OrbitState& state, SimTime to,
                                                   const PropagationSettings& settings = {});

/// State and covariance at `to`, to first order: P <- F P F'.
Outcome<OrbitEstimate> propagate(const ForceModel& forces, const OrbitEstimate& estimate,
                                 SimTime to, const PropagationSettings& settings = {});

}  // namespace dmise
