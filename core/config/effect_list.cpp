#include "core/config/effect_list.h"

#include <algorithm>
#include <vector>

#include "core/detector/detector.h"
#include "core/effects/light_effects.h"
#include "core/effects/place_effects.h"
#include "core/optics/image_optics.h"

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

std::vector<const EffectFacts*> list() {
  std::vector<const EffectFacts*> all(std::begin(effect::places), std::end(effect::places));
  all.insert(all.end(), std::begin(effect::lights), std::end(effect::lights));
  ImageEffects::for_each([&]<class Effect>() { all.push_back(&Effect::facts); });
  DetectorEffects::for_each([&]<class Effect>() { all.push_back(&Effect::facts); });
  return all;
}

}  // namespace

std::span<const EffectFacts* const> all_effects() {
  static const std::vector<const EffectFacts*> all = list();
  return all;
}

std::vector<const EffectFacts*> effects_in(const SensorConfig& sensor, bool has_stars) {
  const bool on_ground = std::holds_alternative<SiteConfig>(sensor.place);
  const SkyParts& parts = sensor.sky.parts;
  const struct {
    const EffectFacts& effect;
    bool applies;
  } conditions[] = {{effect::refraction, on_ground},
                    {effect::extinction, on_ground},
                    {effect::clouds, on_ground && sensor.weather.clouds},
                    {effect::scintillation, on_ground},
                    {effect::stars, has_stars},
                    {effect::airglow, parts.airglow.has_value()},
                    {effect::zodiacal_light, parts.zodiacal_light.has_value()},
                    {effect::faint_starlight, parts.faint_starlight.has_value()},
                    {effect::scattered_moonlight, parts.scattered_moonlight.has_value()},
                    {effect::twilight, parts.twilight.has_value()},
                    {effect::light_pollution, parts.light_pollution.has_value()}};
  std::vector<const EffectFacts*> running;
  const auto add = [&](const EffectFacts* effect) {
    const auto condition =
        std::find_if(std::begin(conditions), std::end(conditions),
                     [&](const auto& c) { return c.effect.name == effect->name; });
    if (sensor.effects.has(*effect) && (condition == std::end(conditions) || condition->applies))
      running.push_back(effect);
  };
  for (const EffectFacts* effect : effect::places) add(effect);
  for (const EffectFacts* effect : effect::lights) add(effect);
  const ImageOptics optics = acting_optics(sensor.camera.optics.image, sensor.effects);
  ImageEffects::for_each([&]<class Effect>() {
    if (static_cast<const Effect&>(optics).applies()) running.push_back(&Effect::facts);
  });
  for (const auto* effect :
       applying_effects(acting_detector(sensor.camera.detector, sensor.effects)))
    running.push_back(effect);
  return running;
}

std::vector<std::pair<std::string_view, double>> parameters_in(const Camera& camera,
                                                               const EffectFacts& effect) {
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
      "# Effects\n\nWritten by `dmise list effects > docs/models/effects.md`. Each can be switched "
      "in "
      "a scenario, `effects: {NAME: off}`, for all\nsensors or one; `dmise check` says which run "
      "and "
      "with what.\n\n| effect | what it does | left out | source | parameters "
      "|\n|---|---|---|---|---|\n";
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
