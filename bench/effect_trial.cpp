#include "bench/effect_trial.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "bench/scene_dice.h"
#include "bench/timing.h"
#include "core/config/sensors/effect_list.h"
#include "core/sky/places/light_time.h"
#include "sensors/objects/objects_in_field.h"
#include "sensors/planning/exposure_planner.h"

namespace dmise {
namespace {

/// Share of a budget that is no fault: a misplaced source also leaves a little light at the rim of
/// its aperture.
constexpr double precision = 0.03;
constexpr int plan_repeats = 5;

SensorConfig with_accuracy(SensorConfig sensor, const Accuracy& accuracy) {
  sensor.accuracy = accuracy;
  return sensor;
}

/// The budgets of a scene: the named ones and one of its own.
std::vector<Accuracy> budgets(std::uint64_t seed, int number) {
  SceneDice dice(seed + 1, std::uint32_t(number));
  Accuracy own{"budget"};
  for (const auto& kind : error_kinds)
    own.budget.*kind.value = standard_budget.*kind.value * dice.log_uniform(0.1, 30.0);
  return {draft_accuracy(), standard_accuracy(), own};
}

bool is_of_detector(const std::string& effect) {
  bool found = false;
  DetectorEffects::for_each([&]<class Effect>() { found = found || effect == Effect::facts.name; });
  return found;
}

/// The planner of a scene's sensor, with the facts of its exposure.
struct Planner {
  const SceneFrames& frames;
  std::shared_ptr<const StarMap> stars = frames.stars();
  SensorConfig sensor = with_accuracy(frames.sensor(), standard_accuracy());
  ObjectShapes shapes{frames.scenario().own_objects, sensor.camera.band, sensor.effects};
  ExposurePlanner planner{sensor, stars.get(), frames.scenario().faintest_star_mag, &shapes};
  View view{sensor, frames.times(), frames.states(), frames.scenario().seed};
  std::vector<std::size_t> objects = objects_in_field(view, &shapes);

  std::vector<PlannableEffect> effects() const {
    SceneFacts scene = scene_facts(sensor);
    scene.stars = stars != nullptr;
    tell_shapes(scene, &shapes);
    return plannable_effects(sensor, scene);
  }
};

}  // namespace

bool LevelTrial::holds(const ErrorKind& kind) const {
  return measured.*kind.value <=
         bound.*kind.value + precision * std::max(budget.*kind.value, standard_budget.*kind.value);
}

bool PlanTrial::within(const ErrorKind& kind) const {
  return measured.*kind.value <= (1.0 + precision) * budget.*kind.value;
}

bool SceneTrial::within_budgets() const {
  return std::ranges::all_of(plans, [](const PlanTrial& plan) {
    return std::ranges::all_of(error_kinds, [&](const auto& kind) { return plan.within(kind); });
  });
}

bool SceneTrial::bounds_hold() const {
  return std::ranges::all_of(levels, [](const LevelTrial& level) {
    return std::ranges::all_of(error_kinds, [&](const auto& kind) { return level.holds(kind); });
  });
}

SceneTrial try_scene(int number, const TrialOptions& options,
                     const std::filesystem::path& directory, Threads& threads) {
  SceneTrial trial{.scene = draw_effect_scene(options.seed, number, directory, threads)};
  const SceneFrames frames(load_scenario(trial.scene.path), "eye", 1, threads);
  const SensorConfig reference = with_accuracy(frames.sensor(), reference_accuracy());
  const FrameProducts exact = frames.make(reference);
  const FrameComparison comparison(frames, exact, exact.plan.effects);
  trial.sources = std::size_t(std::ranges::count_if(
      comparison.sources(), [](const ReferenceSource& source) { return source.counts; }));
  trial.background_pixels = comparison.background_pixels();

  std::map<std::pair<std::string, int>, LevelTrial> levels;
  const Planner planner{frames};
  const PlanFacts facts = planner.planner.facts(planner.view, planner.objects);
  const auto effects = planner.effects();
  for (const Accuracy& accuracy :
       options.effect.empty() ? budgets(options.seed, number) : std::vector<Accuracy>()) {
    const FrameProducts frame = frames.make(with_accuracy(frames.sensor(), accuracy));
    trial.plans.push_back({number, accuracy.name, accuracy.budget, frame.plan.error,
                           comparison.error_of(frame, frame.plan.effects).largest});
    for (const PlannedEffect& effect : frame.plan.planned)
      if (effect.decided && effect.level < effect.facts->reference())
        levels.try_emplace({std::string(effect.facts->name), effect.level},
                           LevelTrial{.bound = effect.error, .budget = accuracy.budget});
  }
  for (const PlannableEffect& effect : effects)
    if (options.every_level || effect.facts->name == options.effect)
      for (int level = 0; effect.error && level < effect.facts->reference(); ++level)
        levels.try_emplace({std::string(effect.facts->name), level},
                           LevelTrial{.bound = effect.error(level, facts)});
  for (auto& [key, level] : levels) {
    const auto effect = std::ranges::find(
        effects, key.first, [](const PlannableEffect& e) { return std::string(e.facts->name); });
    if (effect == effects.end()) continue;
    level.scene = number;
    level.effect = key.first;
    level.level = effect->facts->levels[std::size_t(key.second)];
    level.has_sources = std::ranges::any_of(comparison.sources(), [&key = key](const auto& source) {
      const bool is_object = !source.name.starts_with("star ");
      return source.counts && (is_object || key.first != LightTime::facts.name);
    });
    level.has_background = trial.background_pixels > 0;
    if (is_of_detector(key.first)) {  // the light is the reference's
      EffectSet alone = exact.plan.effects;
      alone.set_level(*effect->facts, key.second);
      level.measured = comparison.error_of(exact, alone).largest;
    } else {
      SensorConfig alone = reference;
      alone.unplanned = reference.effects;
      alone.effects.force_level(*effect->facts, key.second);
      const FrameProducts frame = frames.make(alone);
      level.measured = comparison.error_of(frame, frame.plan.effects).largest;
    }
    trial.levels.push_back(level);
  }
  trial.plan_s =
      median_seconds(plan_repeats, [&] { planner.planner.plan(planner.view, planner.objects); });
  return trial;
}

}  // namespace dmise
