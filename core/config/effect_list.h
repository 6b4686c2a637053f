#pragma once
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/config/scenario.h"

namespace dmise {

/// All effects: those of place, of light and of the detector, each family in its order.
std::span<const EffectFacts* const> all_effects();

/// What runs in a sensor's frames, in the same order.
std::vector<const EffectFacts*> effects_in(const SensorConfig& sensor, bool has_stars);

/// The parameters of an effect in a camera: key and number.
std::vector<std::pair<std::string_view, double>> parameters_in(const Camera& camera,
                                                               const EffectFacts& effect);

/// docs/models/effects.md.
std::string effects_markdown();

/// The names of the effects that a run's digest lists: those that run, of the ones that it always
/// had, and what else is not as usual.
std::vector<std::string_view> effects_in_digest(const EffectSet& effects);

}  // namespace dmise
