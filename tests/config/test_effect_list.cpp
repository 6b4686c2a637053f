#include "core/config/sensors/effect_list.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "core/base/files/text_file.h"
#include "core/config/sensors/effects_config.h"
#include "core/config/yaml/yaml_reader.h"
#include "core/effects/frame_effects.h"
#include "core/facets/facet_light.h"
#include "core/sky/air/air_effects.h"
#include "core/sky/air/dispersion.h"
#include "core/sky/places/place_effects.h"
#include "core/sky/sky_model.h"

namespace dmise {
namespace {

TEST(EffectList, EveryEffectHasANameOfItsOwnAndSaysWhatItIs) {
  std::set<std::string_view> names;
  for (const EffectFacts* effect : all_effects()) {
    EXPECT_TRUE(names.insert(effect->name).second) << effect->name;
    for (const auto text : {effect->what, effect->error_if_off, effect->source})
      EXPECT_FALSE(text.empty()) << effect->name;
  }
}

TEST(EffectList, ItsDocumentIsUpToDate) {
  EXPECT_EQ(read_text_file(DMISE_SOURCE_DIR "/docs/models/effects.md"), effects_markdown())
      << "dmise list effects > docs/models/effects.md";
}

bool runs(const std::vector<const EffectFacts*>& list, const EffectFacts& effect) {
  return std::any_of(list.begin(), list.end(),
                     [&](const EffectFacts* one) { return one->name == effect.name; });
}

TEST(EffectList, EachCanBeSwitchedByItsNameUnlessItHasOtherChoices) {
  for (const EffectFacts* effect : all_effects())
    for (const bool on : {true, false}) {
      EffectSet set;
      const auto read = [&] {
        read_effects(
            YamlValue::parse(std::string(effect->name) + (on ? ": on" : ": off"), "e.yaml"), set);
      };
      if (effect->switchable && effect->can_be_off()) {
        read();
        EXPECT_EQ(set.has(*effect), on) << effect->name;
      } else {  // it has choices of other names
        EXPECT_THROW(read(), ConfigError) << effect->name;
      }
    }
}

TEST(EffectList, ItsDocumentNamesThoseThatCannotBeOff) {
  const std::string page = effects_markdown();
  const std::size_t from = page.find("levels alone"), end = page.find(".\n", from);
  ASSERT_NE(from, std::string::npos);
  const std::string named = page.substr(from, end - from);
  for (const EffectFacts* effect : all_effects())
    EXPECT_EQ(named.find("`" + std::string(effect->name) + "`") != std::string::npos,
              effect->switchable && !effect->can_be_off())
        << effect->name;
}

TEST(EffectList, AStreakThatIsSwitchedOffPointsToItsChoices) {
  EffectSet set;
  try {
    read_effects(YamlValue::parse("streak: off", "e.yaml"), set);
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("integration: analytic or snapshots"),
              std::string::npos)
        << error.what();
  }
}

TEST(EffectList, InSpaceThereIsNoAir) {
  SensorConfig sensor;
  sensor.sky.parts = *sky_parts_named("dark");
  const EffectFacts* of_air[] = {&AtmosphericRefraction::facts,
                                 &AirExtinction::facts,
                                 &Scintillation::facts,
                                 &GasAbsorption::facts,
                                 &Dispersion::facts,
                                 &MovingScintillation::facts,
                                 &CloudCover::facts,
                                 &Airglow::facts,
                                 &Twilight::facts};
  sensor.place = PlatformConfig{};
  sensor.weather.clouds = UniformCloud{};
  sensor.weather.pwv_mm = 3.0;
  for (const auto& asked : {Dispersion::facts, MovingScintillation::facts})
    sensor.effects.set(asked, true);
  for (const EffectFacts* effect : of_air)
    EXPECT_FALSE(runs(effects_in(sensor, scene_facts(sensor)), *effect)) << effect->name;
  EXPECT_TRUE(runs(effects_in(sensor, scene_facts(sensor)), ZodiacalLight::facts));
  sensor.place = SiteConfig{};
  for (const EffectFacts* effect : of_air)
    EXPECT_TRUE(runs(effects_in(sensor, scene_facts(sensor)), *effect)) << effect->name;
}

TEST(EffectList, WhatHasNothingToDoDoesNotRun) {
  SensorConfig sensor;
  sensor.sky.parts = *sky_parts_named("dark");
  SceneFacts scene = scene_facts(sensor);
  scene.stars = scene.shapes = false;
  for (const EffectFacts* effect :
       {&StarBackground::facts, &Occlusion::facts, &ThermalEmission::facts, &Vignetting::facts,
        &CloudCover::facts, &LightPollution::facts})
    EXPECT_FALSE(runs(effects_in(sensor, scene), *effect)) << effect->name;
  EXPECT_TRUE(runs(effects_in(sensor, scene), Airglow::facts));
  sensor.effects.set(SkyBackground::facts, false);
  EXPECT_FALSE(runs(effects_in(sensor, scene), Airglow::facts));
  sensor.camera.optics.vignetting.natural = true;
  EXPECT_TRUE(runs(effects_in(sensor, scene_facts(sensor)), Vignetting::facts));
}

}  // namespace
}  // namespace dmise
