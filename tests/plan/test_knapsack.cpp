#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/plan/knapsack.h"

namespace dmise {
namespace {

struct Optimum {
  double cost_s = unbounded;
};

/// By trying all combinations.
void try_all(const std::vector<KnapsackChoice>& choices, const ErrorBound& budget, std::size_t from,
             const ErrorBound& error, double cost_s, Optimum& best) {
  if (!error.within(budget) || cost_s >= best.cost_s) return;
  if (from == choices.size()) {
    best.cost_s = cost_s;
    return;
  }
  for (const auto& option : choices[from])
    try_all(choices, budget, from + 1, error + option.error, cost_s + option.cost_s, best);
}

std::vector<KnapsackChoice> random_choices(std::mt19937_64& random, std::size_t count) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const auto log_uniform = [&](double decades) { return std::pow(10.0, -decades * unit(random)); };
  std::vector<KnapsackChoice> choices(count);
  for (auto& choice : choices) {
    const int levels = 2 + int(3.0 * unit(random));
    const double full_s = log_uniform(3.0);
    for (int l = 0; l < levels; ++l) {
      KnapsackOption option{.cost_s = full_s * (l + unit(random)) / levels};
      if (l == levels - 1)
        option.cost_s = full_s;
      else
        for (const auto& kind : error_kinds)
          if (unit(random) < 0.5) option.error.*kind.value = log_uniform(3.0);
      choice.push_back(option);
    }
  }
  return choices;
}

TEST(Knapsack, IsWithinTwoPercentOfTheBestOfAllCombinations) {
  std::mt19937_64 random(1);
  double sum = 0.0, best_sum = 0.0, worst = 1.0;
  for (int i = 0; i < 200; ++i) {
    const auto choices = random_choices(random, 9);
    const ErrorBound budget{0.5, 0.5, 0.5, 0.5};
    const KnapsackResult result = solve_knapsack(choices, budget);
    Optimum best;
    try_all(choices, budget, 0, {}, 0.0, best);
    ErrorBound error;
    for (std::size_t k = 0; k < choices.size(); ++k) error += choices[k][result.option[k]].error;
    EXPECT_TRUE(error.within(budget + ErrorBound{1e-9, 1e-9, 1e-9, 1e-9}));
    EXPECT_LE(result.min_cost_s, best.cost_s * (1 + 1e-9)) << "no bound, case " << i;
    EXPECT_GE(result.cost_s, best.cost_s * (1 - 1e-9));
    sum += result.cost_s, best_sum += best.cost_s;
    worst = std::max(worst, result.cost_s / best.cost_s);
  }
  EXPECT_LE(sum, 1.02 * best_sum);
  EXPECT_LE(worst, 1.25);
}

TEST(Knapsack, ABudgetOfZeroTakesWhatIsExact) {
  std::mt19937_64 random(2);
  auto choices = random_choices(random, 6);
  choices[2][0] = {.error = {}, .cost_s = 0.0};  // costs nothing and lacks nothing
  const auto result = solve_knapsack(choices, {});
  ErrorBound error;
  for (std::size_t k = 0; k < choices.size(); ++k) error += choices[k][result.option[k]].error;
  EXPECT_EQ(error, ErrorBound{});
  EXPECT_EQ(result.option[2], 0u);
}

TEST(Knapsack, AnUnboundedBudgetTakesTheCheapest) {
  std::mt19937_64 random(3);
  const auto choices = random_choices(random, 20);
  const auto result = solve_knapsack(choices, not_bounded);
  for (std::size_t k = 0; k < choices.size(); ++k)
    for (const auto& option : choices[k])
      EXPECT_LE(choices[k][result.option[k]].cost_s, option.cost_s);
  EXPECT_DOUBLE_EQ(result.cost_s, result.min_cost_s);
}

}  // namespace
}  // namespace dmise
