#include "core/fusion/sky_cells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "core/base/units.h"

namespace dmise {
namespace {

Vec<Gcrs> any_direction(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return unit(Vec<Gcrs>{normal(random), normal(random), normal(random)});
}

TEST(SkyCells, FindAllDirectionsWithinTheirRadius) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> angle(0.001, 0.1);
  for (const double half_angle : {0.05, 0.7, pi / 2, 3.0, pi}) {
    const Vec<Gcrs> axis = any_direction(random);
    SkyCells cells(axis, half_angle);
    std::vector<std::pair<Vec<Gcrs>, double>> entered;
    for (std::uint32_t id = 0; id < 300; ++id) {
      entered.push_back({any_direction(random), angle(random)});
      cells.add(id, entered.back().first, entered.back().second);
    }
    cells.close();
    std::size_t near = 0;
    for (int trial = 0; trial < 2000; ++trial) {
      const Vec<Gcrs> here = any_direction(random);
      if (angle_rad(here, axis) > half_angle) continue;
      const auto found = cells.near(here);
      EXPECT_TRUE(std::ranges::is_sorted(found));
      near += found.size();
      for (std::uint32_t id = 0; id < entered.size(); ++id)
        if (angle_rad(here, entered[id].first) <= entered[id].second) {
          EXPECT_TRUE(std::ranges::binary_search(found, id)) << half_angle;
        }
    }
    if (half_angle > 1) {
      EXPECT_LT(near, 2000u * 300 / 10);
    }
  }
}

}  // namespace
}  // namespace dmise
