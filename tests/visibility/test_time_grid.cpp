#include "core/visibility/time_grid.h"

#include <gtest/gtest.h>

namespace dmise {
namespace {

TEST(TimeGrid, CoversItsSpanWithAShorterLastStep) {
  const TimeGrid grid = covering_grid({5}, sim_seconds(43200), sim_seconds(3000));
  ASSERT_EQ(grid.steps, 15u);
  EXPECT_EQ(grid.at(14).ns, 5 + sim_seconds(42000).ns);
  EXPECT_EQ(grid.last().ns, 5 + sim_seconds(43200).ns);
  EXPECT_EQ(covering_grid({0}, sim_seconds(60), sim_seconds(3600)).last(), sim_seconds(60));
  EXPECT_EQ(covering_grid({0}, sim_seconds(86400), sim_seconds(10)).steps, 8640u);
}

TEST(FineGrid, HoldsTheGridsInstantsAndNoNeighboursFartherApartThanAsked) {
  for (const double step_s : {0.1, 7.0, 10.0, 10.000000001, 33.333333333, 3000.0, 50000.0}) {
    const TimeGrid grid = covering_grid({-7}, sim_seconds(43201.5), sim_seconds(step_s));
    const FineGrid fine(grid, sim_seconds(10));
    EXPECT_EQ(fine.at(0), grid.from);
    EXPECT_EQ(fine.at(fine.steps()), grid.last());
    std::uint32_t next = 0;
    for (std::size_t k = 0; k <= fine.steps(); ++k) {
      if (k > 0) {
        ASSERT_LT(fine.at(k - 1), fine.at(k)) << step_s;
        ASSERT_LE((fine.at(k) - fine.at(k - 1)).seconds(), std::min(10.0, step_s) + 1e-9);
      }
      if (const auto of_grid = fine.of_grid(k)) {
        ASSERT_EQ(*of_grid, next++) << step_s;
        ASSERT_EQ(grid.at(*of_grid), fine.at(k)) << step_s;
      }
    }
    EXPECT_EQ(next, grid.steps + 1) << step_s;
  }
}

}  // namespace
}  // namespace dmise
