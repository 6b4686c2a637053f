#include "sensors/accuracy/stage_times.h"

#include "core/effects/frame_effects.h"
#include "core/optics/point_spread.h"
#include "core/sky/place_effects.h"
#include "core/sky/sky_model.h"

namespace dmise {

std::string_view timed_as(std::string_view effect, const EffectTimes& measured) {
  if (measured.seconds.contains(effect)) return effect;
  std::string_view stage = effect;
  SkyPartEffects::for_each([&]<class Part>() {
    if (effect == Part::facts.name) stage = SkyBackground::facts.name;
  });
  PlaceEffects::for_each([&]<class Place>() {
    if (effect == Place::facts.name) stage = StarBackground::facts.name;
  });
  if (effect == SkyGrid::facts.name) stage = SkyBackground::facts.name;
  if (effect == PsfWavelengths::facts.name) stage = PointSpread::facts.name;
  return stage;
}

std::map<std::string, StageTime> stage_times(const EffectPlan& plan, const EffectTimes& measured,
                                             const CostFactors& factors) {
  std::map<std::string, StageTime> stages;
  for (const auto& [name, seconds] : measured.seconds)
    stages[std::string(name)].measured_s = seconds;
  for (const PlannedEffect& effect : plan.planned)
    stages[std::string(timed_as(effect.facts->name, measured))].predicted_s +=
        dmise::predicted_s(effect, factors);
  return stages;
}

}  // namespace dmise
