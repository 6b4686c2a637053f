#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/config/scenario.h"
#include "core/effects/plan_facts.h"

namespace dmise {

/// All effects: those of place, of light and of the detector, each family in its order.
std::span<const EffectFacts* const> all_effects();

/// What decides whether effects act in a sensor's frames, as far as the sensor says.
SceneFacts scene_facts(const SensorConfig& sensor);

/// What runs in a sensor's frames, in the same order. `scene` as above, with what else is known.
std::vector<const EffectFacts*> effects_in(const SensorConfig& sensor, const SceneFacts& scene);

/// The same for the planner, with errors and costs by the sensor's parameters, and all that the
/// scenario switches off. `sensor` need not outlive them.
std::vector<PlannableEffect> plannable_effects(const SensorConfig& sensor, const SceneFacts& scene);

/// The levels of a frame of a sensor's recorded plans, all forced. Throws `ConfigError` that names
/// the sensor, the frame and what of the record does not fit: a frame or an effect that it does not
/// have, an effect or a level that there is not.
EffectSet recorded_effects(std::span<const PlannableEffect> effects, const SensorConfig& sensor,
                           std::uint32_t frame);

/// A parameter of an effect: its key in YAML, and its number or numbers.
struct ParameterValue {
  std::string_view key;
  std::vector<double> numbers;
};

/// The parameters of an effect in a sensor.
std::vector<ParameterValue> parameters_in(const SensorConfig& sensor, const EffectFacts& effect);

/// docs/models/effects.md.
std::string effects_markdown();

/// The names of the effects that a run's digest lists: those that run, of the ones that it always
/// had, and what else is not as usual.
std::vector<std::string> effects_in_digest(const EffectSet& effects);

}  // namespace dmise
