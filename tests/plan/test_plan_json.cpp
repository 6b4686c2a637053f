#include "core/plan/plan_json.h"

#include <gtest/gtest.h>

namespace dmise {
namespace {

constexpr EffectFacts chosen{"chosen", "", "", ""}, kept{"kept", "", "", ""};

EffectPlan plan_of_two() {
  EffectPlan plan{.budget = not_bounded, .error = {.position_px = 0.5}, .min_cost_s = 0.1};
  plan.planned = {
      {.facts = &chosen, .level = 1, .cost_s = 0.25, .cheaper = not_bounded, .decided = true},
      {.facts = &kept, .level = 1}};
  return plan;
}

TEST(PlanJson, WhatIsNotBoundedIsNoNumber) {
  JsonWriter json;
  write_plan(json, plan_of_two());
  const std::string text = json.take();
  EXPECT_EQ(text.find("inf"), std::string::npos) << text;
  EXPECT_EQ(text.find("nan"), std::string::npos) << text;
  EXPECT_NE(text.find("\"position_px\":0.5"), std::string::npos) << text;
}

TEST(PlanJson, LevelsOfAllEffectsAndReasonsOfThoseThatWereDecided) {
  JsonWriter json;
  write_plan(json, plan_of_two());
  const std::string text = json.take();
  EXPECT_NE(text.find("\"kept\":{\"level\":\"on\"}"), std::string::npos) << text;
  EXPECT_NE(text.find("\"why\""), std::string::npos) << text;
}

TEST(PlanJson, SecondsArePredictedForTheMachine) {
  JsonWriter json;
  write_plan(json, plan_of_two(), {{"chosen", 2.0}});
  EXPECT_NE(json.take().find("\"predicted_s\":0.5"), std::string::npos);
}

}  // namespace
}  // namespace dmise
