#pragma once
#include <array>

#include "core/sim/state.h"

namespace dmise {

/// States at `tick`, between those at the ticks of `before` and `after`: the cubic through
/// positions and slopes, its derivative as slope and velocity, and attitudes as consumers
/// interpolate them. An object without a state at one of the two has none.
ObjectStates joined_states(const ObjectStates& before, const ObjectStates& after, Tick tick,
                           SimTime time);

/// Error [m] of the cubic between two neighbours of three equidistant states, for object `i`: a
/// 16th of what the cubic over both intervals is off in the middle, as for a smooth path, or what a
/// jump of the velocity there makes of it. Infinite if one has no state.
double cubic_error_m(const std::array<const ObjectStates*, 3>& three, std::size_t i);

}  // namespace dmise
