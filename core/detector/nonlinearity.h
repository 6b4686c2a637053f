#pragma once
#include <span>

namespace dmise {

/// Signal that the amplifier makes of charge: e (1 - loss e / full well), a loss of `loss` at full
/// well.
void nonlinearity(double loss, double full_well_e, std::span<float> electrons);

}  // namespace dmise
