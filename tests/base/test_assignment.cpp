#include "core/base/numeric/assignment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <random>

#include "core/base/error.h"

namespace dmise {
namespace {

using Costs = std::map<std::pair<std::size_t, std::size_t>, double>;

Costs costs_of(const std::vector<Pairing>& pairs) {
  Costs out;
  for (const Pairing& p : pairs) {
    const auto [it, fresh] = out.emplace(std::pair(p.row, p.column), p.cost);
    if (!fresh) it->second = std::min(it->second, p.cost);
  }
  return out;
}

/// The least sum over all choices, one after the other.
double min_cost(const Costs& costs, std::size_t row, std::size_t rows, std::size_t columns,
                unsigned used) {
  if (row == rows) return 0;
  double best = min_cost(costs, row + 1, rows, columns, used);
  for (std::size_t column = 0; column < columns; ++column)
    if (const auto found = costs.find({row, column});
        found != costs.end() && !(used & 1u << column))
      best = std::min(best,
                      found->second + min_cost(costs, row + 1, rows, columns, used | 1u << column));
  return best;
}

double cost_of(const std::vector<std::size_t>& found, const Costs& costs) {
  double sum = 0;
  for (std::size_t row = 0; row < found.size(); ++row)
    if (found[row] != unassigned) sum += costs.at({row, found[row]});
  return sum;
}

// Reference: all assignments of up to 6 rows to 6 columns, enumerated.
TEST(Assignment, IsTheCheapestOfAll) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> cost(-10, 5), chance(0, 1);
  for (int trial = 0; trial < 2000; ++trial) {
    const std::size_t rows = random() % 7, columns = random() % 7;
    const double density = chance(random);
    std::vector<Pairing> pairs;
    for (std::size_t i = 0; i < rows; ++i)
      for (std::size_t j = 0; j < columns; ++j)
        if (chance(random) < density) pairs.push_back({i, j, cost(random)});
    if (!pairs.empty()) pairs.push_back(pairs.front()), pairs.back().cost += 1;
    const auto found = assign(rows, columns, pairs);
    ASSERT_EQ(found.size(), rows);
    for (std::size_t i = 0; i < rows; ++i)
      for (std::size_t j = 0; j < i; ++j)
        ASSERT_TRUE(found[i] == unassigned || found[i] != found[j]);
    const Costs costs = costs_of(pairs);
    ASSERT_NEAR(cost_of(found, costs), min_cost(costs, 0, rows, columns, 0), 1e-9);
    std::shuffle(pairs.begin(), pairs.end(), random);
    ASSERT_EQ(assign(rows, columns, pairs), found);
  }
}

TEST(Assignment, LeavesAloneWhatCostsMoreThanNothing) {
  EXPECT_EQ(assign(2, 1, std::vector<Pairing>{{0, 0, 0.5}, {1, 0, -0.5}}),
            (std::vector<std::size_t>{unassigned, 0}));
}

TEST(Assignment, RefusesWhatIsOutOfRange) {
  EXPECT_THROW(assign(1, 1, std::vector<Pairing>{{0, 1, 0.0}}), Error);
  EXPECT_THROW(assign(1, 1, std::vector<Pairing>{{0, 0, std::numeric_limits<double>::quiet_NaN()}}),
               Error);
}

}  // namespace
}  // namespace dmise
