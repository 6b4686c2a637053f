#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/effects/plannable_effect.h"

namespace dmise {

/// One effect in a plan.
struct PlannedEffect {
  const EffectFacts* facts = nullptr;
  int level = 0;
  ErrorBound error;      // at this level
  double cost_s = 0.0;   // by the shipped table
  ErrorBound cheaper;    // error of the next lower level; zero at the lowest
  bool forced = false;   // by the user
  bool decided = false;  // among several levels

  std::string_view level_name() const { return facts->levels[std::size_t(level)]; }
};

/// The levels of all effects for an exposure.
struct EffectPlan {
  EffectSet effects;
  std::vector<PlannedEffect> planned;  // those that apply, in the order in which they run
  ErrorBound budget;
  ErrorBound error;       // the sum over all effects
  double cost_s = 0.0;    // over all effects, too
  double min_cost_s = 0;  // no plan within the budget costs less
  bool in_time = true;    // false: no plan is as fast as was asked; this is the fastest
  bool replayed = false;  // its levels are those of another run
};

/// Chooses one level for each effect: the cheapest levels whose errors sum up to no more than the
/// budget, or the smallest multiple of the standard budget whose plan keeps the time. Levels that
/// `asked` forces stay. Deterministic: it depends on the arguments alone.
///
/// The choice is a multiple-choice knapsack in four dimensions: multipliers by subgradients give a
/// lower bound of the cost, and exchanges of one and two effects improve what they find. How far
/// the plan may be from the optimum is `cost_s - min_cost_s`. Throws `Error` for a budget or a
/// time that is negative or no number, and for an effect whose error or cost is none.
EffectPlan plan_effects(std::span<const PlannableEffect> effects, const PlanFacts& facts,
                        const EffectSet& asked, const Accuracy& accuracy);

/// Returns the plan that takes the levels of `recorded`, with their errors and costs in this
/// exposure and without a budget. As by `plan_effects`, levels that `asked` forces have no error.
/// An error is not bounded where a level leaves out what no plan would.
EffectPlan replayed_plan(std::span<const PlannableEffect> effects, const PlanFacts& facts,
                         const EffectSet& asked, const EffectSet& recorded);

/// Returns the reason for a level in one short text.
std::string why(const PlannedEffect& planned, const EffectPlan& plan);

}  // namespace dmise
