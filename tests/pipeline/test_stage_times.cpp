#include "sensors/scene/stage_times.h"

#include <gtest/gtest.h>

#include "core/effects/frame_effects.h"
#include "core/sky/airglow.h"

namespace dmise {
namespace {

TEST(StageTimes, PartsOfTheSkyAreTimedWithIt) {
  EffectPlan plan;
  plan.planned.push_back({.facts = &SkyGrid::facts, .cost_s = 0.2});
  plan.planned.push_back({.facts = &Airglow::facts, .cost_s = 0.1});
  EffectTimes measured;
  measured[SkyBackground::facts] = 0.5;
  const auto stages = stage_times(plan, measured, {{"airglow", 3.0}});
  ASSERT_EQ(stages.size(), 1u);
  EXPECT_DOUBLE_EQ(stages.at("sky").predicted_s, 0.2 + 3.0 * 0.1);
  EXPECT_DOUBLE_EQ(stages.at("sky").measured_s, 0.5);
}

}  // namespace
}  // namespace dmise
