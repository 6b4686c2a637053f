#include "sensors/pipeline/world.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"

namespace dmise {
namespace {

/// One object on a circle, with exact slopes.
std::shared_ptr<const ObjectStates> circle(Tick tick, SimTime time) {
  const double radius = 7e6, rate = 1.08e-3, a = rate * time.seconds();
  auto s = std::make_shared<ObjectStates>();
  s->tick = tick;
  s->time = time;
  s->count = 1;
  s->position_m = {radius * std::cos(a), radius * std::sin(a), 0};
  s->slope_m_per_s = {-radius * rate * std::sin(a), radius * rate * std::cos(a), 0};
  s->velocity_m_per_s = s->slope_m_per_s;
  s->code = {0};
  return s;
}

TEST(World, InterpolatesBetweenTicksToTheCubicsError) {
  World world;
  for (Tick k = 0; k < 3; ++k) world.add(circle(k, sim_seconds(5.0 * double(k))));
  const SimTime t = sim_seconds(7.5);
  const auto motion = world.motion(0, t);
  const auto exact = circle(0, t);
  // h^4 / 384 of the fourth derivative, r n^4: 1.6e-5 m.
  EXPECT_LT(norm(motion.position_m - exact->position(0)), 2e-5);
  EXPECT_LT(norm(motion.slope_m_per_s - exact->slope(0)), 1e-4);
}

TEST(World, RefusesTimesItDoesNotHold) {
  World world;
  world.add(circle(0, {0}));
  world.add(circle(1, sim_seconds(5)));
  EXPECT_THROW(world.motion(0, sim_seconds(6)), Error);
  world.add(circle(2, sim_seconds(10)));
  world.forget_before(sim_seconds(6));
  EXPECT_NO_THROW(world.motion(0, sim_seconds(6)));
  EXPECT_THROW(world.motion(0, sim_seconds(4)), Error);
}

TEST(World, FindsObjectsByNumberOrByAnUnambiguousName) {
  const ObjectRoster roster{{{.catalogue_number = 5, .name = "DEB"},
                             {.catalogue_number = 6, .name = "DEB"},
                             {.catalogue_number = 7, .name = "METOP-A"}}};
  EXPECT_EQ(object_index(roster, "6", "x"), 1u);
  EXPECT_EQ(object_index(roster, "METOP-A", "x"), 2u);
  EXPECT_THROW(object_index(roster, "DEB", "x"), ConfigError);
  try {
    object_index(roster, "METOP-B", "sensor");
    FAIL();
  } catch (const ConfigError& e) {
    EXPECT_STREQ(e.what(), "sensor: no such object, did you mean METOP-A?, got METOP-B");
  }
}

}  // namespace
}  // namespace dmise
