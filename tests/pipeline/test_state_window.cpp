#include "sensors/scene/state_window.h"

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

TEST(StateWindow, InterpolatesBetweenTicksToTheCubicsError) {
  StateWindow window;
  for (Tick k = 0; k < 3; ++k) window.add(circle(k, sim_seconds(5.0 * double(k))));
  const SimTime t = sim_seconds(7.5);
  const auto motion = window.motion(0, t);
  const auto exact = circle(0, t);
  // h^4 / 384 of the fourth derivative, r n^4: 1.6e-5 m.
  EXPECT_LT(norm(motion.position_m - exact->position(0)), 2e-5);
  EXPECT_LT(norm(motion.slope_m_per_s - exact->slope(0)), 1e-4);
}

// On a circle the remainders are r (n h)^6 / 6! and r (n h)^8 / 8! times the product of the squared
// distances from the ticks: at most 0.148 and, at the run's edges, 1.0. Against the circle itself.
TEST(StateWindow, HigherOrdersMeetLongTicksAlsoAtTheEdgesOfTheRun) {
  const double h_s = 120, nh = 1.08e-3 * h_s;
  for (const auto& [order, bound_m] :
       {std::pair(HermiteOrder::quintic, 7e6 * std::pow(nh, 6) / 720 * 0.15),
        std::pair(HermiteOrder::septic, 7e6 * std::pow(nh, 8) / 40320 * 1.01)}) {
    StateWindow window(order, 6);
    for (Tick k = 0; k <= 6; ++k) window.add(circle(k, sim_seconds(h_s * double(k))));
    for (double t_s = 0; t_s <= 720; t_s += 7.5) {
      const auto motion = window.motion(0, sim_seconds(t_s));
      const auto exact = circle(0, sim_seconds(t_s));
      EXPECT_LT(norm(motion.position_m - exact->position(0)), bound_m + 1e-8) << t_s;
      EXPECT_LT(norm(motion.slope_m_per_s - exact->slope(0)), 0.1 * bound_m + 1e-8) << t_s;
    }
  }
}

// What is forgotten changes nothing: the ticks that the order takes stay.
TEST(StateWindow, KeepsTheTicksBeyondTheInterval) {
  for (const auto order : {HermiteOrder::quintic, HermiteOrder::septic}) {
    StateWindow all(order, 9), few(order, 9);
    for (Tick k = 0; k <= 9; ++k) {
      const SimTime time = sim_seconds(60.0 * double(k));
      all.add(circle(k, time));
      few.add(circle(k, time));
      for (Tick half = 1; half <= 2 * k; ++half) {  // whatever is ready now, on ticks and between
        const SimTime asked = sim_seconds(30.0 * double(half));
        if (tick_needed(order, asked, sim_seconds(60), 9) != k) continue;
        few.forget_before(asked);
        EXPECT_EQ(few.motion(0, asked).position_m, all.motion(0, asked).position_m)
            << k << " " << half;
      }
    }
  }
}

// A neighbour without a state (the end of a trajectory) leaves the cubic of the two around.
TEST(StateWindow, FallsBackToTheCubicWhereANeighbourHasNoState) {
  StateWindow septic(HermiteOrder::septic, 3), cubic;
  for (Tick k = 0; k <= 3; ++k) {
    auto state = std::make_shared<ObjectStates>(*circle(k, sim_seconds(10.0 * double(k))));
    if (k == 3) state->code = {1};
    septic.add(state);
    cubic.add(state);
  }
  const SimTime t = sim_seconds(14);
  EXPECT_EQ(septic.motion(0, t).position_m, cubic.motion(0, t).position_m);
}

TEST(StateWindow, RefusesTimesItDoesNotHold) {
  StateWindow window;
  window.add(circle(0, {0}));
  window.add(circle(1, sim_seconds(5)));
  EXPECT_THROW(window.motion(0, sim_seconds(6)), Error);
  window.add(circle(2, sim_seconds(10)));
  window.forget_before(sim_seconds(6));
  EXPECT_NO_THROW(window.motion(0, sim_seconds(6)));
  EXPECT_THROW(window.motion(0, sim_seconds(4)), Error);
}

TEST(StateWindow, HasTheAirThatWasToldLast) {
  StateWindow window;
  for (Tick k = 0; k < 3; ++k)
    for (const char* sensor : {"a", "b"})
      window.add(std::make_shared<const SiteState>(
          SiteState{.tick = k,
                    .time = sim_seconds(60.0 * double(k)),
                    .sensor = sensor,
                    .pressure_hpa = 1000 + double(k) + (*sensor == 'b' ? 100 : 0)}));
  EXPECT_EQ(window.site("a", sim_seconds(59))->pressure_hpa, 1000);
  EXPECT_EQ(window.site("a", sim_seconds(60))->pressure_hpa, 1001);
  EXPECT_EQ(window.site("b", sim_seconds(500))->pressure_hpa, 1102);
  EXPECT_EQ(window.site("c", sim_seconds(500)), nullptr);
}

TEST(StateWindow, FindsObjectsByNumberOrByAnUnambiguousName) {
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
