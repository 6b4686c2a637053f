#include "core/effects/acting_effects.h"

#include <gtest/gtest.h>

#include <string>

namespace dmise {
namespace {

struct Air {
  static constexpr EffectFacts facts{"air", "", "", ""};
  static bool applies(const SceneFacts& scene) { return scene.on_ground; }
  explicit Air(int exposure) : number(exposure) {}
  int number;
};
struct Rare {
  static constexpr EffectFacts facts{"rare", "", "", "", false};
};
struct Plain {
  static constexpr EffectFacts facts{"plain", "", "", ""};
};
using Listed = EffectList<Air, Rare, Plain>;

std::string acting(const EffectSet& switched, const SceneFacts& scene) {
  std::string names;
  ActingEffects<Listed>(switched, scene, 7).for_each([&](const auto& effect) {
    names += std::string(effect.facts.name) + " ";
  });
  return names;
}

TEST(ActingEffects, AreTheUsualOnesThatApplyInTheOrderOfTheirList) {
  EXPECT_EQ(acting({}, {}), "air plain ");
  EXPECT_EQ(acting({}, {.on_ground = false}), "plain ");
}

TEST(ActingEffects, AreSwitchedByAScenario) {
  EffectSet set;
  set.set(Rare::facts, true);
  set.set(Plain::facts, false);
  EXPECT_EQ(acting(set, {}), "air rare ");
  set.set(Rare::facts, false);
  set.set(Plain::facts, true);
  EXPECT_EQ(set, EffectSet());
}

TEST(ActingEffects, AreMadeFromTheFactsOfTheExposure) {
  const ActingEffects<Listed> effects({}, {}, 7);
  ASSERT_NE(effects.find<Air>(), nullptr);
  EXPECT_EQ(effects.find<Air>()->number, 7);
  EXPECT_EQ(effects.find<Rare>(), nullptr);
}

}  // namespace
}  // namespace dmise
