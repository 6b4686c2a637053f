#include "core/plan/planner.h"

#include <cmath>

#include "core/base/error.h"
#include "core/base/formatted.h"
#include "core/effects/plan_facts.h"
#include "core/plan/knapsack.h"

namespace dmise {
namespace {

/// Multiples of the standard budget that are tried for a given time: powers of the fourth root of
/// two from 2^-10 on, and at last any error.
constexpr int scales = 81;
double scale_of(int step) { return std::exp2(-10.0 + 0.25 * step); }

constexpr double largest = std::numeric_limits<double>::max();
constexpr ErrorBound largest_budget{largest, largest, largest, largest};

/// The levels of an effect that may be taken.
struct Levels {
  const PlannableEffect* effect;
  bool forced = false;
  std::vector<int> level;
  KnapsackChoice options;
};

void check(double value, const char* what) {
  if (std::isnan(value) || value < 0.0)
    throw Error(std::string("accuracy: ") + what + " must be >= 0, got " + std::to_string(value));
}

KnapsackOption option_of(const PlannableEffect& effect, int level, const PlanFacts& facts) {
  KnapsackOption option{.error = level == effect.facts->reference() || !effect.error
                                     ? ErrorBound{}
                                     : effect.error(level, facts),
                        .cost_s = effect.cost_s ? effect.cost_s(level, facts) : 0.0};
  bool valid = option.cost_s >= 0.0 && std::isfinite(option.cost_s);
  for (const auto& kind : error_kinds) valid = valid && option.error.*kind.value >= 0.0;
  if (!valid)
    throw Error("plan: effect " + std::string(effect.facts->name) + ", level " +
                std::string(effect.facts->levels[std::size_t(level)]) +
                ": its error or cost is no number");
  return option;
}

/// `recorded`: takes its levels alone; null: all that may be taken.
Levels levels_of(const PlannableEffect& effect, const PlanFacts& facts, const EffectSet& asked,
                 const EffectSet* recorded = nullptr) {
  Levels levels{.effect = &effect, .forced = asked.is_forced(*effect.facts)};
  const int unplanned = asked.level(*effect.facts);
  // What a scenario must ask for, and what states no error, is left as it is.
  const bool fixed = levels.forced || !effect.error || !effect.facts->usual;
  for (int level = 0; level <= effect.facts->reference(); ++level) {
    if (recorded ? level != recorded->level(*effect.facts) : fixed && level != unplanned) continue;
    KnapsackOption option = option_of(effect, level, facts);
    if (fixed) option.error = {};
    // What must not be left out stays, whatever the budget.
    if (!recorded && !option.error.within(largest_budget)) continue;
    levels.level.push_back(level);
    levels.options.push_back(option);
  }
  return levels;
}

/// The plan that takes one option of each effect.
EffectPlan plan_of(const std::vector<Levels>& levels, const std::vector<std::size_t>& option,
                   const PlanFacts& facts, const EffectSet& asked, const ErrorBound& budget) {
  EffectPlan plan{.effects = asked, .budget = budget};
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const Levels& l = levels[i];
    const std::size_t taken = option[i];
    PlannedEffect planned{.facts = l.effect->facts,
                          .level = l.level[taken],
                          .error = l.options[taken].error,
                          .cost_s = l.options[taken].cost_s,
                          .forced = l.forced,
                          .decided = l.level.size() > 1};
    for (int lower = planned.level - 1; planned.decided && lower >= 0; --lower) {
      planned.cheaper = l.effect->error(lower, facts);
      if (planned.cheaper != planned.error) break;
    }
    plan.effects.set_level(*l.effect->facts, planned.level);
    plan.error += planned.error;
    plan.cost_s += planned.cost_s;
    plan.planned.push_back(planned);
  }
  return plan;
}

EffectPlan plan_within(const std::vector<Levels>& levels, const PlanFacts& facts,
                       const EffectSet& asked, const ErrorBound& budget) {
  std::vector<KnapsackChoice> choices;
  for (const auto& l : levels) choices.push_back(l.options);
  const KnapsackResult result = solve_knapsack(choices, budget);
  EffectPlan plan = plan_of(levels, result.option, facts, asked, budget);
  plan.min_cost_s = result.min_cost_s;
  return plan;
}

EffectPlan plan_in_time(const std::vector<Levels>& levels, const PlanFacts& facts,
                        const EffectSet& asked, double seconds) {
  const auto plan_at = [&](int step) {
    ErrorBound budget = not_bounded;
    if (step < scales)
      for (const auto& kind : error_kinds)
        budget.*kind.value = standard_budget.*kind.value * scale_of(step);
    return plan_within(levels, facts, asked, budget);
  };
  EffectPlan plan = plan_within(levels, facts, asked, {});
  if (plan.cost_s <= seconds) return plan;
  int too_slow = -1, fast_enough = scales;
  plan = plan_at(scales);
  plan.in_time = plan.cost_s <= seconds;
  if (!plan.in_time) return plan;
  while (fast_enough - too_slow > 1) {
    const int middle = (too_slow + fast_enough) / 2;
    EffectPlan tried = plan_at(middle);
    if (tried.cost_s <= seconds)
      fast_enough = middle, plan = std::move(tried);
    else
      too_slow = middle;
  }
  return plan;
}

/// The kind of error that takes the largest share of its budget; null if none takes any.
const ErrorKind* largest_share(const ErrorBound& error, const ErrorBound& budget) {
  const ErrorKind* worst = nullptr;
  double most = 0.0;
  for (const auto& kind : error_kinds) {
    const double value = error.*kind.value, of = budget.*kind.value;
    const double share = value == 0.0                     ? 0.0
                         : of == 0.0 || std::isinf(value) ? unbounded
                                                          : value / of;
    if (share > most) most = share, worst = &kind;
  }
  return worst;
}

}  // namespace

EffectPlan plan_effects(std::span<const PlannableEffect> effects, const PlanFacts& facts,
                        const EffectSet& asked, const Accuracy& accuracy) {
  for (const auto& kind : error_kinds) check(accuracy.budget.*kind.value, kind.key);
  check(accuracy.seconds_per_frame, "seconds_per_frame");
  std::vector<Levels> levels;
  for (const auto& effect : effects) levels.push_back(levels_of(effect, facts, asked));
  if (accuracy.name == "seconds")
    return plan_in_time(levels, facts, asked, accuracy.seconds_per_frame);
  return plan_within(levels, facts, asked, accuracy.budget);
}

EffectPlan replayed_plan(std::span<const PlannableEffect> effects, const PlanFacts& facts,
                         const EffectSet& asked, const EffectSet& recorded) {
  std::vector<Levels> levels;
  for (const auto& effect : effects) levels.push_back(levels_of(effect, facts, asked, &recorded));
  const std::vector<std::size_t> only(levels.size(), 0);
  EffectPlan plan = plan_of(levels, only, facts, asked, not_bounded);
  plan.min_cost_s = plan.cost_s;
  plan.replayed = true;
  return plan;
}

std::string why(const PlannedEffect& planned, const EffectPlan& plan) {
  if (plan.replayed) return "as the replayed plan says";
  if (planned.forced) return "as the scenario says";
  if (!planned.decided) return "always";
  const bool at_reference = planned.level == planned.facts->reference();
  const ErrorBound& error = at_reference ? planned.cheaper : planned.error;
  const ErrorKind* worst = largest_share(error, plan.budget);
  // Where no kind that matters is bounded: the largest in standard budgets.
  if (!worst) worst = largest_share(error, standard_budget);
  if (!worst) return at_reference ? "nothing to save" : "no error here";
  const double value = error.*worst->value, budget = plan.budget.*worst->value;
  if (std::isinf(value)) return "must not be left out here";
  return formatted("%s%.2g %s of %s", at_reference ? "the next lower level would cost " : "", value,
                   worst->unit,
                   std::isinf(budget) ? "unbounded" : formatted("%.2g", budget).c_str());
}

}  // namespace dmise
