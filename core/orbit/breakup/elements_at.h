#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "core/orbit/elements/elements.h"
#include "core/orbit/motion_state.h"

namespace dmise {

enum class ElementsFault : std::uint8_t {
  none,
  open,     // a parabola, a hyperbola, or a state that is not finite
  no_path,  // SGP4 has no path through the state
};

/// Element sets of which SGP4's position and velocity at `epoch` are the given states: to 1 m and 1
/// mm/s, mostly to 1 mm. `sets` bring their B*, number and name; all else is
/// overwritten. Where the result is a fault, the set is of no use. Every set is a function of its
/// own state alone.
///
/// One instant is met exactly, not an arc: pieces of a breakup begin at one point. SGP4 then drifts
/// from the path of the state by what its theory leaves out, a few hundred metres a revolution.
std::vector<ElementsFault> fit_elements_at(const Utc& epoch,
                                           std::span<const MotionState<Teme>> states,
                                           std::span<MeanElements> sets);

}  // namespace dmise
