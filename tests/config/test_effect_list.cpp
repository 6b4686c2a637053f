#include "core/config/effect_list.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "core/base/text_file.h"
#include "core/config/sensor_config.h"
#include "core/effects/light_effects.h"
#include "core/effects/place_effects.h"

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

TEST(EffectList, EachCanBeSwitchedByItsName) {
  for (const EffectFacts* effect : all_effects())
    for (const bool on : {true, false}) {
      EffectSet set;
      read_effects(YamlValue::parse(std::string(effect->name) + (on ? ": on" : ": off"), "e.yaml"),
                   set);
      EXPECT_EQ(set.has(*effect), on) << effect->name;
    }
}

TEST(EffectList, InSpaceThereIsNoAir) {
  SensorConfig sensor;
  sensor.place = PlatformConfig{};
  const auto in_space = effects_in(sensor, true);
  const auto runs = [](const auto& list, const EffectFacts& effect) {
    return std::find(list.begin(), list.end(), &effect) != list.end();
  };
  for (const EffectFacts* effect :
       {&effect::refraction, &effect::extinction, &effect::scintillation, &effect::clouds})
    EXPECT_FALSE(runs(in_space, *effect)) << effect->name;
  sensor.place = SiteConfig{};
  EXPECT_TRUE(runs(effects_in(sensor, true), effect::refraction));
  EXPECT_FALSE(runs(effects_in(sensor, false), effect::stars));
}

}  // namespace
}  // namespace dmise
