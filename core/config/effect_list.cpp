#include "core/config/effect_list.h"

#include <algorithm>
#include <vector>

#include "core/detector/detector.h"
#include "core/effects/frame_effects.h"
#include "core/facets/earthshine.h"
#include "core/optics/image_optics.h"
#include "core/sky/air_effects.h"
#include "core/sky/occultation.h"
#include "core/sky/place_effects.h"
#include "core/sky/shadow.h"

namespace dmise {
namespace {

// A later effect changes the digests of those runs alone that switch it.
constexpr std::string_view always_listed[] = {"proper_motion",
                                              "parallax",
                                              "light_deflection",
                                              "annual_aberration",
                                              "diurnal_aberration",
                                              "light_time",
                                              "refraction",
                                              "extinction",
                                              "clouds",
                                              "scintillation",
                                              "shadow",
                                              "earthshine",
                                              "earth_occultation",
                                              "stars",
                                              "objects",
                                              "sky",
                                              "airglow",
                                              "zodiacal_light",
                                              "faint_starlight",
                                              "scattered_moonlight",
                                              "twilight",
                                              "light_pollution",
                                              "psf",
                                              "prnu",
                                              "photon_noise",
                                              "dark_current",
                                              "hot_pixels",
                                              "cosmic_rays",
                                              "reference_pixels",
                                              "persistence",
                                              "full_well",
                                              "blooming",
                                              "interpixel_coupling",
                                              "nonlinearity",
                                              "column_noise",
                                              "read_noise",
                                              "quantisation"};

/// What makes expected electrons of sources and of the sky, in the order in which it runs. The
/// sky's parts, the air's effects and those of the image have lists of their own, where they run.
using LightEffects =
    EffectList<SkyBackground, Airglow, ZodiacalLight, FaintStarlight, ScatteredMoonlight, Twilight,
               LightPollution, SpaceObjects, EarthShadow, Earthshine, ThermalEmission,
               StarBackground, EarthOccultation, AirExtinction, CloudCover, Scintillation,
               Vignetting, Streak, Occlusion, Drawing, PointSpread>;

std::vector<const EffectFacts*> list() {
  std::vector<const EffectFacts*> all;
  const auto add = [&]<class Effect>() { all.push_back(&Effect::facts); };
  PlaceEffects::for_each(add);
  LightEffects::for_each(add);
  ImageEffects::for_each(add);
  DetectorEffects::for_each(add);
  return all;
}

/// Whether an effect is a part of the sky that a sensor does not have.
template <class Effect>
bool is_missing_from_sky(const SensorConfig& sensor) {
  if constexpr (requires { sensor.sky.parts.*sky_part<Effect>; })
    return !(sensor.effects.has(SkyBackground::facts) && sensor.sky.parts.*sky_part<Effect>);
  else
    return false;
}

}  // namespace

std::span<const EffectFacts* const> all_effects() {
  static const std::vector<const EffectFacts*> all = list();
  return all;
}

SceneFacts scene_facts(const SensorConfig& sensor) {
  return {.on_ground = std::holds_alternative<SiteConfig>(sensor.place),
          .clouds = sensor.weather.clouds.has_value(),
          .vignettes = sensor.camera.optics.vignetting.any()};
}

std::vector<const EffectFacts*> effects_in(const SensorConfig& sensor, const SceneFacts& scene) {
  std::vector<const EffectFacts*> running;
  const auto add = [&]<class Effect>() {
    if (acts<Effect>(sensor.effects, scene) && !is_missing_from_sky<Effect>(sensor))
      running.push_back(&Effect::facts);
  };
  PlaceEffects::for_each(add);
  LightEffects::for_each(add);
  const ImageOptics optics = acting_optics(sensor.camera.optics.image, sensor.effects);
  ImageEffects::for_each([&]<class Effect>() {
    if (static_cast<const Effect&>(optics).applies()) running.push_back(&Effect::facts);
  });
  for (const auto* effect :
       applying_effects(acting_detector(sensor.camera.detector, sensor.effects)))
    running.push_back(effect);
  return running;
}

std::vector<std::pair<std::string_view, double>> parameters_in(const SensorConfig& sensor,
                                                               const EffectFacts& effect) {
  const Camera& camera = sensor.camera;
  const Vignetting& v = camera.optics.vignetting;
  if (effect.name == Vignetting::facts.name)
    return {{"natural", v.natural}, {"corner", v.corner}, {"power", v.power}};
  if (effect.name == Streak::facts.name && sensor.effects.snapshots() > 0)
    return {{"snapshots", sensor.effects.snapshots()}};
  std::vector<std::pair<std::string_view, double>> numbers;
  ImageEffects::for_each([&]<class Effect>() {
    if (Effect::facts.name == effect.name)
      for (const ImageParameter& p : Effect::parameters())
        numbers.emplace_back(p.key, camera.optics.image.*p.value);
  });
  DetectorEffects::for_each([&]<class Effect>() {
    if (Effect::facts.name == effect.name)
      for (const DetectorParameter& p : Effect::parameters())
        numbers.emplace_back(p.key, p.number_of(camera.detector));
  });
  return numbers;
}

std::string effects_markdown() {
  std::string text =
      "# Effects\n\n"
      "Written by `dmise list effects > docs/models/effects.md`, in the order in which they run.\n"
      "Each can be switched in a scenario, `effects: {NAME: off}`, for all sensors or one, but "
      "for\n"
      "`streak` (`integration: analytic | snapshots`, `snapshots: N`) and `evaluator` (`analytic "
      "|\n"
      "opengl`), which have other choices. `dmise check` shows which run and with what.\n\n"
      "| effect | what it does | left out | source | parameters |\n|---|---|---|---|---|\n";
  for (const EffectFacts* effect : all_effects()) {
    std::string keys;
    for (const auto& [key, number] : parameters_in({}, *effect))
      keys += (keys.empty() ? "`" : ", `") + std::string(key) + "`";
    for (const auto cell : {effect->name, effect->what, effect->error_if_off, effect->source})
      text +=
          (cell == effect->name ? "| `" + std::string(cell) + "`" : "| " + std::string(cell)) + " ";
    text += "| " + keys + " |\n";
  }
  return text;
}

std::vector<std::string_view> effects_in_digest(const EffectSet& effects) {
  std::vector<std::string_view> names;
  const auto named = [](std::string_view name) {
    return *std::find_if(all_effects().begin(), all_effects().end(),
                         [&](const EffectFacts* effect) { return effect->name == name; });
  };
  for (const auto name : always_listed)
    if (effects.has(*named(name))) names.push_back(name);
  for (const EffectFacts* effect : all_effects())
    if (std::find(std::begin(always_listed), std::end(always_listed), effect->name) ==
            std::end(always_listed) &&
        effects.has(*effect) != effect->usual)
      names.push_back(effect->name);
  return names;
}

}  // namespace dmise
