#pragma once
#include <span>
#include <string_view>
#include <vector>

#include "core/effects/effects.h"

namespace dmise {

/// All effects: those of place, of light and of the detector, each family in its order.
std::span<const EffectFacts* const> all_effects();

/// The names of the effects that a run's digest lists: those that run, of the ones that it always
/// had, and what else is not as usual.
std::vector<std::string_view> effects_in_digest(const EffectSet& effects);

}  // namespace dmise
