#include "core/sky/stars/star_index.h"

#include <gtest/gtest.h>

#include <random>

#include "core/base/units.h"
#include "core/sky/stars/star_map.h"

namespace dmise {
namespace {

StarCatalogue random_stars(std::size_t count, double faintest_v_mag = 9.0) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  StarCatalogue c;
  for (std::size_t i = 0; i < count; ++i)
    append_star(c, {.id = std::uint32_t(i),
                    .ra_rad = 2 * pi * uniform(random),
                    .dec_rad = std::asin(2 * uniform(random) - 1),
                    .v_mag = faintest_v_mag * uniform(random)});
  append_star(c, {.ra_rad = 0.0, .dec_rad = pi / 2, .v_mag = 2.0});
  append_star(c, {.ra_rad = 3.0, .dec_rad = -pi / 2, .v_mag = 2.0});
  return c;
}

/// Against looking at every star.
void expect_cone(const StarMap& map, double ra, double dec, double radius, double faintest_v_mag) {
  const Vec<Gcrs> axis = from_spherical<Gcrs>(ra, dec);
  std::vector<std::uint32_t> found, expected;
  query_cone(map, axis, radius, faintest_v_mag, found);
  for (std::uint32_t i = 0; i < map.stars.size(); ++i)
    if (map.stars.v_mag[i] <= faintest_v_mag && angle_rad(map.index.direction[i], axis) <= radius)
      expected.push_back(i);
  EXPECT_EQ(found, expected) << ra << " " << dec << " " << radius << " " << faintest_v_mag;
}

// Cones over poles, through 0 h, from a point to the whole sphere.
TEST(StarIndex, FindsExactlyTheStarsInTheCone) {
  const StarMap map = star_map_of(random_stars(20000));
  for (const double ra : {0.0, 0.001, 1.0, 6.28})
    for (const double dec : {-90.0, -89.5, -30.0, 0.0, 45.0, 88.0, 90.0})
      for (const double radius : {0.0, 0.01, 0.5, 3.0, 30.0, 89.0, 119.7, 180.0})
        expect_cone(map, ra, dec * deg, radius * deg, 6.0);
}

TEST(StarIndex, FindsExactlyTheStarsInConesOfAManyTieredCatalogue) {
  const StarMap map = star_map_of(random_stars(max_stars_at_once + 100'000, 22.0));
  ASSERT_GT(map.index.tiers.size(), 1u);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int i = 0; i < 100; ++i)
    expect_cone(map, 2 * pi * uniform(random), std::asin(2 * uniform(random) - 1),
                pi * std::pow(uniform(random), 4), 25 * uniform(random));
  for (const double dec : {-pi / 2, pi / 2})
    for (const double faintest : {8.0, 9.0, 9.5, 20.0, 99.0})
      expect_cone(map, 1, dec, 0.1, faintest);
}

TEST(StarIndex, FindsAStarExactlyOnTheAxisInAConeOfNoWidth) {
  StarCatalogue stars = random_stars(10);
  const StarIndex index = build_star_index(stars);
  std::vector<std::uint32_t> found;
  query_cone(stars.v_mag, index, index.direction[3], 0.0, 99.0, found);
  EXPECT_EQ(found, std::vector<std::uint32_t>{3});
}

TEST(StarIndex, DoesNotDependOnTheOrderOfTheFileBeyondEqualStars) {
  StarCatalogue forward = random_stars(1000), backward;
  for (std::size_t i = forward.size(); i-- > 0;)
    append_star(backward, {.id = forward.id[i],
                           .ra_rad = forward.ra_rad[i],
                           .dec_rad = forward.dec_rad[i],
                           .v_mag = forward.v_mag[i]});
  build_star_index(forward);
  build_star_index(backward);
  EXPECT_EQ(forward.ra_rad, backward.ra_rad);
}

}  // namespace
}  // namespace dmise
