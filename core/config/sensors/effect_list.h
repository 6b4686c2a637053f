#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/config/sensors/sensor_settings.h"
#include "core/effects/plannable_effect.h"

namespace dmise {

/// All effects: those of place, of light and of the detector, each family in its order.
std::span<const EffectFacts* const> all_effects();

/// Returns what the sensor alone says of whether effects act in its frames.
SceneFacts scene_facts(const SensorConfig& sensor);

/// Returns the effects that run in a sensor's frames, in the order of `all_effects`. `scene`:
/// `scene_facts` with what else is known of the exposure.
std::vector<const EffectFacts*> effects_in(const SensorConfig& sensor, const SceneFacts& scene);

/// Returns them for the planner, with errors and costs by the sensor's parameters, including those
/// that the scenario switches off. `sensor` need not outlive them.
std::vector<PlannableEffect> plannable_effects(const SensorConfig& sensor, const SceneFacts& scene);

/// Returns the levels of a frame in a sensor's recorded plans, all forced. Throws `ConfigError`
/// that names the sensor and the frame if the record lacks the frame or an effect, or has an effect
/// or a level that does not exist.
EffectSet recorded_effects(std::span<const PlannableEffect> effects, const SensorConfig& sensor,
                           std::uint32_t frame);

/// A parameter of an effect: its key in YAML, and its number or numbers.
struct ParameterValue {
  std::string_view key;
  std::vector<double> numbers;
};

/// The parameters of an effect in a sensor.
std::vector<ParameterValue> parameters_in(const SensorConfig& sensor, const EffectFacts& effect);

/// Returns the text of docs/models/effects.md.
std::string effects_markdown();

/// Returns the names of the effects that a run's digest lists, with levels that are not the usual
/// ones: `NAME:LEVEL`, and `NAME!` if the scenario forces it.
std::vector<std::string> effects_in_digest(const EffectSet& effects);

}  // namespace dmise
