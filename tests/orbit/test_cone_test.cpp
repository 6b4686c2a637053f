#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "core/base/units.h"
#include "core/orbit/cones/cone_test.h"
#include "tests/support/simd.h"

namespace dmise {
namespace {

class ConeTest : public testing::TestWithParam<SimdLevel> {};
INSTANTIATE_TEST_SUITE_P(Simd, ConeTest, testing::ValuesIn(test::simd_here()), test::simd_name);

bool bit(const std::vector<std::uint64_t>& bits, std::size_t words, std::size_t cone,
         std::size_t i) {
  return bits[cone * words + i / 64] >> (i % 64) & 1u;
}

// Reference: the angle itself, by atan2 of cross and dot product.
TEST_P(ConeTest, AgreesWithTheAngleForNarrowAndWideCones) {
  std::mt19937_64 rng(7);
  std::normal_distribution<double> normal;
  const auto direction = [&] { return unit(Vec<Teme>{normal(rng), normal(rng), normal(rng)}); };
  constexpr std::size_t n = 1003;
  std::vector<Vec<Teme>> objects;
  std::vector<double> position(3 * n);
  for (std::size_t i = 0; i < n; ++i) {
    objects.push_back(direction() * (6.6e6 + 1e5 * double(i % 400)));
    position[i] = objects[i].x, position[i + n] = objects[i].y, position[i + 2 * n] = objects[i].z;
  }
  std::vector<Cone> cones;
  for (double half_angle_deg : {0.5, 10.0, 45.0, 80.0, 90.0, 100.0, 135.0, 179.0, 180.0})
    for (double height_m : {0.0, 4e5, 3e7})
      cones.push_back({direction() * (6378137.0 + height_m), direction(), half_angle_deg * deg});
  Threads threads(2);
  const std::size_t words = cone_words(n);
  std::vector<std::uint64_t> inside(words * cones.size(), ~std::uint64_t{0});
  cone_test(position, cones, inside, &threads, GetParam());
  std::size_t found = 0;
  for (std::size_t s = 0; s < cones.size(); ++s) {
    for (std::size_t i = 0; i < n; ++i) {
      const double angle = angle_rad(objects[i] - cones[s].apex_m, cones[s].axis);
      if (std::fabs(angle - cones[s].half_angle_rad) < 1e-9) continue;
      EXPECT_EQ(bit(inside, words, s, i), angle < cones[s].half_angle_rad);
      found += angle < cones[s].half_angle_rad;
    }
    EXPECT_EQ(inside[s * words + words - 1] >> (n % 64), 0u);
  }
  EXPECT_GT(found, 10000u);
}

TEST_P(ConeTest, LeavesOutTheHostItselfAndObjectsWithoutAState) {
  const std::vector<double> position = {0.0, 7e6, 7.1e6, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  const std::vector<Cone> cones = {{{7e6, 0, 0}, {1, 0, 0}, 10 * deg},
                                   {{7e6, 0, 0}, {-1, 0, 0}, 170 * deg},
                                   {{7e6, 0, 0}, {1, 0, 0}, 180 * deg}};
  std::vector<std::uint64_t> inside(3);
  cone_test(position, cones, inside, nullptr, GetParam());
  EXPECT_EQ(inside, (std::vector<std::uint64_t>{4, 0, 4}));
}

}  // namespace
}  // namespace dmise
