#pragma once
#include "core/effects/effects.h"

namespace dmise {

/// Moonlight on objects, also on those in the Earth's shadow; not where the Earth is between.
struct Moonlight {
  static constexpr EffectFacts facts{"moonlight", "moonlight on objects (off unless asked for)",
                                     "2.5e-6 of full sunlight at full Moon: all that there is in "
                                     "the Earth's shadow but for earthshine",
                                     "Krisciunas & Schaefer 1991, PASP 103, 1033", false};
};

}  // namespace dmise
