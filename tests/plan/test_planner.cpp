#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/effects/plan_facts.h"
#include "core/plan/planner.h"

namespace dmise {
namespace {

constexpr std::array<std::string_view, 4> grades{"off", "coarse", "fine", "exact"};
constexpr EffectFacts graded{"graded", "", "", "", true, true, grades, 2};
constexpr EffectFacts plain{"plain", "", "", ""};
constexpr EffectFacts on_wish{"on_wish", "", "", "", false};
constexpr EffectFacts fixed{"fixed", "", "", ""};

const std::vector<PlannableEffect> effects{
    {&graded,
     [](int level, const PlanFacts&) {
       return ErrorBound{.photometry_mag = level == 0 ? 1.0 : level == 1 ? 0.1 : 0.001};
     },
     [](int level, const PlanFacts&) { return std::pow(10.0, level - 3.0); }},
    {&plain, [](int, const PlanFacts& f) { return ErrorBound{.position_px = f.refraction_rad}; },
     [](int level, const PlanFacts&) { return 0.01 * level; }},
    {&on_wish, [](int, const PlanFacts&) { return ErrorBound{.photometry_mag = 0.5}; },
     [](int level, const PlanFacts&) { return 5.0 * level; }},
    {&fixed, nullptr, [](int, const PlanFacts&) { return 0.002; }}};

EffectPlan plan(const Accuracy& accuracy, const EffectSet& asked = {}, double position_px = 0.2) {
  PlanFacts facts;
  facts.refraction_rad = position_px;
  return plan_effects(effects, facts, asked, accuracy);
}

/// What a plan says of an effect.
const PlannedEffect& of(const EffectPlan& plan, const EffectFacts& effect) {
  return *std::ranges::find(plan.planned, effect.name,
                            [](const PlannedEffect& p) { return p.facts->name; });
}

TEST(Planner, TakesTheCheapestLevelsWithinTheBudget) {
  const EffectPlan standard = plan(standard_accuracy());
  EXPECT_EQ(of(standard, graded).level_name(), "fine");  // 0.001 of 0.01 mag
  EXPECT_EQ(of(standard, plain).level_name(), "on");     // 0.2 of 0.05 px
  EXPECT_EQ(standard.effects.level(on_wish), 0);
  EXPECT_DOUBLE_EQ(standard.cost_s, 0.1 + 0.01 + 0.002);
  const EffectPlan draft = plan(draft_accuracy());
  EXPECT_EQ(of(draft, graded).level_name(), "coarse");
  EXPECT_EQ(of(draft, plain).level_name(), "off");
  EXPECT_TRUE(draft.error.within(draft_budget));
}

TEST(Planner, ReferenceTakesTheLastLevels) {
  const EffectPlan reference = plan(reference_accuracy());
  EXPECT_EQ(of(reference, graded).level_name(), "exact");
  EXPECT_EQ(reference.error, ErrorBound{});
}

TEST(Planner, WhatCostsNoErrorIsLeftOutOfTheReferenceToo) {
  EXPECT_EQ(of(plan(reference_accuracy(), {}, 0.0), plain).level_name(), "off");
}

TEST(Planner, LeavesForcedLevelsAndChargesThemToNobody) {
  EffectSet asked;
  asked.force_level(graded, 0);
  asked.force(on_wish, true);
  const EffectPlan forced = plan(standard_accuracy(), asked);
  EXPECT_EQ(of(forced, graded).level_name(), "off");
  EXPECT_EQ(forced.effects.level(on_wish), 1);
  EXPECT_EQ(forced.error.photometry_mag, 0.0);
  EXPECT_EQ(why(of(forced, graded), forced), "as the scenario says");
}

TEST(Planner, KeepsATimeWithTheSmallestError) {
  const auto in = [](double seconds) {
    return plan({.name = "seconds", .budget = {}, .seconds_per_frame = seconds});
  };
  EXPECT_EQ(in(2.0).error, ErrorBound{});
  EXPECT_EQ(of(in(0.5), graded).level_name(), "fine");
  EXPECT_EQ(of(in(0.05), graded).level_name(), "coarse");
  EXPECT_LE(in(0.05).cost_s, 0.05);
  EXPECT_FALSE(in(1e-6).in_time);
  EXPECT_EQ(of(in(1e-6), graded).level_name(), "off");
  EXPECT_TRUE(in(1.0).in_time);
}

TEST(Planner, RefusesWhatIsNoBudget) {
  Accuracy accuracy = standard_accuracy();
  accuracy.budget.position_px = std::nan("");
  EXPECT_THROW(plan(accuracy), Error);
  accuracy.budget.position_px = -1.0;
  EXPECT_THROW(plan(accuracy), Error);
  EXPECT_THROW(plan({.name = "seconds", .budget = {}, .seconds_per_frame = std::nan("")}), Error);
  EXPECT_NO_THROW(plan({.name = "budget", .budget = not_bounded}));
}

TEST(Planner, AnEffectThatStatesNoNumberIsNamed) {
  std::vector<PlannableEffect> broken = effects;
  broken[1].error = [](int, const PlanFacts&) { return ErrorBound{.noise = std::nan("")}; };
  try {
    plan_effects(broken, {}, {}, standard_accuracy());
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("effect plain"), std::string::npos);
  }
}

TEST(Planner, SaysWhichErrorDecided) {
  const EffectPlan standard = plan(standard_accuracy());
  EXPECT_EQ(why(of(standard, plain), standard), "the next lower level would cost 0.2 px of 0.05");
  EXPECT_EQ(why(of(standard, graded), standard), "0.001 mag of 0.01");
}

// A time that no plan keeps has no bound of errors: what is left out says how much it lacks.
TEST(Planner, SaysTheErrorWithoutABudget) {
  const EffectPlan fastest = plan({.name = "seconds", .budget = {}, .seconds_per_frame = 1e-9});
  EXPECT_EQ(why(of(fastest, graded), fastest), "1 mag of unbounded");
  EXPECT_EQ(why(of(fastest, plain), fastest), "0.2 px of unbounded");
  const EffectPlan without = plan({.name = "budget", .budget = not_bounded}, {}, 0.0);
  EXPECT_EQ(why(of(without, plain), without), "no error here");
  // Some kinds alone have a budget.
  const EffectPlan some = plan({.name = "budget",
                                .budget = {.photometry_mag = 0.2,
                                           .position_px = unbounded,
                                           .background_sigma = unbounded,
                                           .noise = unbounded}});
  EXPECT_EQ(why(of(some, graded), some), "0.1 mag of 0.2");
  EXPECT_EQ(why(of(some, plain), some), "0.2 px of unbounded");
}

TEST(Planner, AReplayedPlanHasTheErrorsOfItsLevels) {
  EffectSet asked;
  asked.force_level(on_wish, 1);
  const EffectPlan draft = plan(draft_accuracy(), asked);
  PlanFacts facts;
  facts.refraction_rad = 0.2;
  const EffectPlan replayed = replayed_plan(effects, facts, asked, draft.effects);
  EXPECT_EQ(replayed.error, draft.error);
  EXPECT_EQ(replayed.effects, draft.effects);
  EXPECT_DOUBLE_EQ(replayed.cost_s, draft.cost_s);
  EXPECT_EQ(why(of(replayed, graded), replayed), "as the replayed plan says");
  std::vector<PlannableEffect> vital = effects;
  vital[1].error = [](int, const PlanFacts&) { return not_bounded; };
  EXPECT_EQ(replayed_plan(vital, facts, asked, draft.effects).error.noise, unbounded);
}

}  // namespace
}  // namespace dmise
