#include "core/config/effect_list.h"

#include <algorithm>
#include <vector>

#include "core/detector/detector.h"
#include "core/effects/light_effects.h"
#include "core/effects/place_effects.h"

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
  DetectorEffects::for_each([&]<class Effect>() { all.push_back(&Effect::facts); });
  return all;
}

}  // namespace

std::span<const EffectFacts* const> all_effects() {
  static const std::vector<const EffectFacts*> all = list();
  return all;
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
