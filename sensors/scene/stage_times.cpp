#include "sensors/scene/stage_times.h"

#include "core/detector/detector.h"
#include "core/effects/frame_effects.h"
#include "core/optics/point_spread.h"
#include "core/optics/range_defocus.h"
#include "core/optics/waves/air_turbulence.h"
#include "core/sky/places/place_effects.h"
#include "core/sky/sky_model.h"

namespace dmise {

std::string_view stage_of(std::string_view effect) {
  std::string_view stage = effect;
  const auto within = [&](const EffectFacts& part, const EffectFacts& whole) {
    if (effect == part.name) stage = whole.name;
  };
  SkyPartEffects::for_each([&]<class Part>() { within(Part::facts, SkyBackground::facts); });
  PlaceEffects::for_each([&]<class Place>() { within(Place::facts, StarBackground::facts); });
  within(ResolvedShapes::facts, SpaceObjects::facts);
  within(SkyGrid::facts, SkyBackground::facts);
  within(AirTurbulence::facts, PointSpread::facts);
  within(PsfWavelengths::facts, PointSpread::facts);
  within(FieldBlur::facts, PointSpread::facts);
  within(FocusDrift::facts, PointSpread::facts);
  within(RangeDefocus::facts, SpaceObjects::facts);
  within(DarkCurrent::facts, PhotonNoise::facts);
  within(ReadNoise::facts, PhotonNoise::facts);
  return stage;
}

std::map<std::string, StageTime> stage_times(const EffectPlan& plan, const EffectTimes& measured,
                                             const CostFactors& factors) {
  std::map<std::string, StageTime> stages;
  for (const auto& [name, seconds] : measured.seconds)
    stages[std::string(stage_of(name))].measured_s += seconds;
  for (const PlannedEffect& effect : plan.planned)
    stages[std::string(stage_of(effect.facts->name))].predicted_s +=
        dmise::predicted_s(effect, factors);
  return stages;
}

}  // namespace dmise
