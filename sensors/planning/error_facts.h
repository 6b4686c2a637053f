#pragma once
#include "sensors/scene/view.h"

namespace dmise {

/// Adds what a sensor does not know of itself in an exposure: sizes of its errors, and how fast
/// stars pass its camera, which moves by its clock.
void add_error_facts(const View& view, PlanFacts& facts);

}  // namespace dmise
