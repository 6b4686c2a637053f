#include "core/conjunction/close_approaches.h"

#include <gtest/gtest.h>

#include "core/base/units.h"
#include "core/orbit/elements/catalogue.h"
#include "core/time/iso8601.h"
#include "tests/support/data.h"

namespace dmise {
namespace {

// Reference: tests/reference/close_approaches.py launch/catalogues/demo.tle 2018-01-20T00:00:00 24
// 40 41617, by sgp4 of PyPI.
TEST(CloseApproaches, AreThoseOfSgp4OfPypi) {
  const struct {
    double time_s;
    std::uint32_t number;
    double miss_km;
  } expected[] = {{462.176, 41171, 38.7791},   {946.176, 11251, 30.9989},
                  {22218.858, 5118, 30.089},   {22651.595, 39136, 13.8446},
                  {24999.645, 42873, 28.4662}, {27911.166, 5118, 14.7437}};
  const auto elements = read_catalogue(test::catalogue_path("demo.tle")).elements;
  std::size_t first = 0;
  while (elements[first].catalogue_number != 41617) ++first;
  const Clock clock(parse_utc("2018-01-20T00:00:00Z"));
  const auto found = close_approaches(
      elements, clock,
      {.of = {first}, .duration = sim_seconds(28000), .within_m = 40 * km, .radius_m = 10});
  ASSERT_EQ(found.size(), std::size(expected));
  for (std::size_t i = 0; i < found.size(); ++i) {
    const Encounter& e = found[i].encounter;
    EXPECT_EQ(elements[found[i].second].catalogue_number, expected[i].number);
    EXPECT_NEAR(e.first.state.time.seconds(), expected[i].time_s, 0.05);
    EXPECT_NEAR(norm(relative_motion(e).position_m) / km, expected[i].miss_km, 0.005);
    const double p = collision_probability(e);
    EXPECT_GE(p, 0);
    EXPECT_LT(p, 1e-4);
  }
}

TEST(CloseApproaches, CountAPairOfWantedObjectsOnce) {
  const auto elements = read_catalogue(test::catalogue_path("demo.tle")).elements;
  std::size_t a = 0, b = 0;
  while (elements[a].catalogue_number != 41617) ++a;
  while (elements[b].catalogue_number != 41171) ++b;
  const Clock clock(parse_utc("2018-01-20T00:00:00Z"));
  const auto found = close_approaches(
      {elements[a], elements[b]}, clock,
      {.of = {0, 1}, .duration = sim_seconds(900), .within_m = 40 * km, .radius_m = 10});
  EXPECT_EQ(found.size(), 1u);
}

}  // namespace
}  // namespace dmise
