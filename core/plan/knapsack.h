#pragma once
#include <cstddef>
#include <vector>

#include "core/effects/accuracy.h"

namespace dmise {

/// One way to run an effect.
struct KnapsackOption {
  ErrorBound error;
  double cost_s = 0.0;
};

/// The options of one effect; the last one is exact.
using KnapsackChoice = std::vector<KnapsackOption>;

struct KnapsackResult {
  std::vector<std::size_t> option;  // index for each choice
  double cost_s = 0.0;
  double min_cost_s = 0.0;  // lower bound of the optimum
};

/// Takes one option of each choice so that the errors sum up to no more than `budget` at a low
/// cost: the multiple-choice knapsack in four dimensions. Deterministic. The last option of each
/// choice must have no error, so that there is always a solution.
KnapsackResult solve_knapsack(const std::vector<KnapsackChoice>& choices, const ErrorBound& budget);

}  // namespace dmise
