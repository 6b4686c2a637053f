#include "core/forces/numerical_flight.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"
#include "core/orbit/two_body.h"
#include "tests/support/data.h"
#include "tests/support/flights.h"

namespace dmise {
namespace {

using test::on_path;
using test::orekit_flights;

constexpr double hour_s = 3600, standard_gravity_m_per_s2 = 9.80665;

/// Forces of a point mass alone, about which everything is known.
FlightForces point_mass(const Clock& clock) {
  return {std::make_shared<const EarthSurroundings>(clock, -day_s, day_s),
          {.gravity_degree = 0, .sun_moon = false}};
}

Clock any_clock() { return Clock(parse_utc("2018-12-24T22:00:00")); }

const MotionState<Gcrs> low_orbit{{6878137.0, 0, 0}, {0, -944.0, 7553.0}};

bool is_finite(const NumericalPath& path) {
  for (const OemSegment& s : path.segments)
    for (std::size_t i = 0; i < s.time_s.size(); ++i)
      if (!std::isfinite(norm(s.position_m[i])) || !std::isfinite(norm(s.velocity_m_per_s[i])))
        return false;
  return true;
}

// Reference: tests/reference/flight_with_orekit.py, with the same forces: EGM2008, drag, sunlight
// with penumbra, Sun and Moon by DE440, tides by the IERS Conventions.
TEST(NumericalFlight, IsWithinAMetreOfOrekitAfterADay) {
  const std::string finals = test::data_path("eop/finals2000A.all.gz");
  if (!test::exists(finals)) {
    ASSERT_EQ(std::getenv("DMISE_DATA"), nullptr) << finals;
    GTEST_SKIP() << "no " << finals;
  }
  const Clock clock = test::orekit_clock(finals);
  for (const auto& flight : orekit_flights) {
    const bool manoeuvres = std::string(flight.name) == "manoeuvres";
    const NumericalPath path =
        integrate_flight(test::forces_of(flight, clock), test::flight_of(flight));
    EXPECT_EQ(path.segments.size(), manoeuvres ? 4u : 1u);
    EXPECT_TRUE(path.ends.empty());
    for (int i = 0; i < 4; ++i) {
      const auto& expected = flight.every_six_hours[i];
      const auto state = on_path(path, clock, 21600.0 * (i + 1));
      // The hyperbola passes the Moon, of which ERFA has the place to 10 arcsec, 20 km.
      const double limit_m = std::string(flight.name) == "hyperbola" ? 300 : 1.0;
      EXPECT_LT(norm(state.position_m - expected.position_m), limit_m) << flight.name << " " << i;
      EXPECT_LT(norm(state.velocity_m_per_s - expected.velocity_m_per_s), limit_m * 1e-3);
    }
  }
}

// Reference: the conic sections of core/orbit/two_body.h. Times between the ends of steps, too.
TEST(NumericalFlight, OfAPointMassIsAConicOfAnyEccentricityForwardsAndBack) {
  const Clock clock = any_clock();
  const FlightForces forces = point_mass(clock);
  for (const double eccentricity : {0.0, 0.1, 0.7, 0.999, 1.0, 1.5, 3.0}) {
    const MotionState<Gcrs> start = state_of({.periapsis_m = 6.9e6,
                                              .eccentricity = eccentricity,
                                              .inclination_rad = 1.1,
                                              .true_anomaly_rad = -1.0});
    const NumericalPath path =
        integrate_flight(forces, {.state = start, .from_s = -6 * hour_s, .to_s = 6 * hour_s});
    ASSERT_EQ(path.segments.size(), 1u);
    for (double t = -6 * hour_s; t <= 6 * hour_s; t += 437) {
      const auto state = on_path(path, clock, t);
      const auto expected = propagate_two_body(start, t);
      EXPECT_LT(norm(state.position_m - expected.position_m), 0.02) << eccentricity << " " << t;
      EXPECT_LT(norm(state.velocity_m_per_s - expected.velocity_m_per_s), 2e-5);
    }
  }
}

TEST(NumericalFlight, ThereAndBackIsTheStart) {
  const Clock clock = any_clock();
  const FlightForces forces(std::make_shared<const EarthSurroundings>(clock, 0.0, day_s),
                            {.gravity_degree = 20, .radiation_m2_per_kg = 0.02});
  const auto there = integrate_flight(forces, {.state = low_orbit, .from_s = 0, .to_s = day_s});
  const auto end = on_path(there, clock, day_s);
  const auto back =
      integrate_flight(forces, {.epoch_s = day_s, .state = end, .from_s = 0, .to_s = day_s});
  EXPECT_LT(norm(on_path(back, clock, 0).position_m - low_orbit.position_m), 0.05);
}

// An epoch before or after the span, or within it, is of the same path.
TEST(NumericalFlight, EpochMayBeAnyTime) {
  const Clock clock = any_clock();
  const FlightForces forces = point_mass(clock);
  for (const double epoch_s : {-5 * hour_s, 0.0, 1234.0, hour_s, 9 * hour_s}) {
    const auto path = integrate_flight(forces, {.epoch_s = epoch_s,
                                                .state = propagate_two_body(low_orbit, epoch_s),
                                                .from_s = 0,
                                                .to_s = hour_s});
    ASSERT_EQ(path.segments.size(), 1u) << epoch_s;
    EXPECT_EQ(path.segments[0].usable_start_s, 0) << epoch_s;
    EXPECT_EQ(path.segments[0].usable_stop_s, hour_s) << epoch_s;
    for (const double t : {0.0, 1000.0, hour_s})
      EXPECT_LT(
          norm(on_path(path, clock, t).position_m - propagate_two_body(low_orbit, t).position_m),
          0.01);
  }
}

TEST(NumericalFlight, AShortPathHasTheKnotsOfAPolynomial) {
  const Clock clock = any_clock();
  const auto path =
      integrate_flight(point_mass(clock), {.state = low_orbit, .from_s = 0, .to_s = 90});
  for (const double t : {0.0, 7.0, 45.0, 89.0})
    EXPECT_LT(
        norm(on_path(path, clock, t).position_m - propagate_two_body(low_orbit, t).position_m),
        1e-4);
}

// Reference: energy after a transverse impulse on a circle (vis-viva).
TEST(NumericalFlight, AnImpulseChangesVelocityAtItsInstantAlone) {
  const Clock clock = any_clock();
  const double speed = std::sqrt(earth_gm_m3_per_s2 / 7e6);
  const MotionState<Gcrs> circle{{7e6, 0, 0}, {0, speed, 0}};
  const auto path = integrate_flight(
      point_mass(clock), {.state = circle,
                          .from_s = 0,
                          .to_s = hour_s,
                          .manoeuvres = {{.at_s = 1000, .delta_v_m_per_s = {0, 10, 0}}}});
  ASSERT_EQ(path.segments.size(), 2u);
  const auto before = on_path(path, clock, 999.999), after = on_path(path, clock, 1000);
  EXPECT_NEAR(norm(after.velocity_m_per_s) - norm(before.velocity_m_per_s), 10, 1e-6);
  const auto end = on_path(path, clock, hour_s);
  const double energy = dot(end.velocity_m_per_s, end.velocity_m_per_s) / 2 -
                        earth_gm_m3_per_s2 / norm(end.position_m);
  EXPECT_NEAR(-earth_gm_m3_per_s2 / (2 * energy),
              1 / (2 / 7e6 - (speed + 10) * (speed + 10) / earth_gm_m3_per_s2), 0.05);
}

// A burn about the instant of an impulse differs from it by terms of its length squared, and by the
// turn of the axes with the velocity, which is of the square of the impulse.
TEST(NumericalFlight, AShortBurnIsTheImpulseToFirstOrder) {
  const Clock clock = any_clock();
  const FlightForces forces = point_mass(clock);
  const Vec<Rtn> direction{0.48, 0.64, -0.6};
  constexpr double delta_v = 0.2, mass_kg = 300, middle_s = 1500;
  const auto end_of = [&](const Manoeuvre& manoeuvre) {
    const auto path = integrate_flight(
        forces, {.state = low_orbit, .from_s = 0, .to_s = hour_s, .manoeuvres = {manoeuvre}});
    return on_path(path, clock, hour_s).position_m;
  };
  const Vec<Gcrs> impulse = end_of({.at_s = middle_s, .delta_v_m_per_s = direction * delta_v});
  const auto off = [&](double length_s) {
    return norm(end_of({.at_s = middle_s - length_s / 2,
                        .duration_s = length_s,
                        .thrust_n = mass_kg * delta_v / length_s,
                        .mass_kg = mass_kg,
                        .direction = direction}) -
                impulse);
  };
  const double long_m = off(200), short_m = off(100);
  EXPECT_LT(long_m, 3);
  EXPECT_NEAR(short_m, long_m / 4, 0.02 * long_m);
  EXPECT_LT(off(1), 0.01);
}

// Reference: Tsiolkovsky's equation, far from everything.
TEST(NumericalFlight, ABurnThatUsesMassGivesTheVelocityOfTsiolkovsky) {
  const Clock clock = any_clock();
  const MotionState<Gcrs> far{{4e10, 0, 0}, {0, 1000, 0}};
  const auto path =
      integrate_flight(point_mass(clock), {.state = far,
                                           .from_s = 0,
                                           .to_s = hour_s,
                                           .manoeuvres = {{.at_s = 600,
                                                           .duration_s = 900,
                                                           .thrust_n = 400,
                                                           .mass_kg = 1000,
                                                           .direction = {1, 0, 0},
                                                           .specific_impulse_s = 300}}});
  const double used_kg = 400 * 900 / (300 * standard_gravity_m_per_s2);
  EXPECT_NEAR(on_path(path, clock, hour_s).velocity_m_per_s.x,
              300 * standard_gravity_m_per_s2 * std::log(1000 / (1000 - used_kg)),
              1e-3 + hour_s * earth_gm_m3_per_s2 / 16e20);
}

TEST(NumericalFlight, ZeroThrustAndAZeroImpulseChangeNothing) {
  const Clock clock = any_clock();
  const FlightForces forces = point_mass(clock);
  const auto path = integrate_flight(
      forces,
      {.state = low_orbit,
       .from_s = 0,
       .to_s = hour_s,
       .manoeuvres = {{.at_s = 500, .duration_s = 60, .mass_kg = 10, .direction = {0, 1, 0}},
                      {.at_s = 2000}}});
  EXPECT_EQ(path.segments.size(), 4u);
  for (const double t : {400.0, 530.0, 1999.0, 2000.0, 3500.0})
    EXPECT_LT(
        norm(on_path(path, clock, t).position_m - propagate_two_body(low_orbit, t).position_m),
        2e-3);
}

// Impulses at one instant, a nanosecond apart, and beside a burn of a millisecond. Their sum is 0
// but for the turn of the axes by the normal ones: 3 x 3 / 7600 m/s forwards, three times that
// later on.
TEST(NumericalFlight, ManoeuvresMayBeAsCloseAsTheyLike) {
  const Clock clock = any_clock();
  const auto path = integrate_flight(
      point_mass(clock), {.state = low_orbit,
                          .from_s = 0,
                          .to_s = hour_s,
                          .manoeuvres = {{.at_s = 1000, .delta_v_m_per_s = {0, 0, 3}},
                                         {.at_s = 1000, .delta_v_m_per_s = {0, 0, -3}},
                                         {.at_s = 1000.000000001, .delta_v_m_per_s = {0, 5, 0}},
                                         {.at_s = 1000.000000002,
                                          .duration_s = 0.001,
                                          .thrust_n = 5000,
                                          .mass_kg = 1,
                                          .direction = {0, -1, 0}}}});
  EXPECT_TRUE(is_finite(path));
  for (const double t :
       {999.0, 999.999999999, 1000.0, 1000.000000001, 1000.0005, 1000.5, 1001.0, 1030.0, 3500.0})
    EXPECT_LT(
        norm(on_path(path, clock, t).position_m - propagate_two_body(low_orbit, t).position_m),
        t > 1000.001 ? 0.005 * (t - 999) : 0.02)
        << t;
}

TEST(NumericalFlight, ThatDecaysEndsOnTheGroundWithOneReason) {
  const Clock clock = any_clock();
  const FlightForces forces(std::make_shared<const EarthSurroundings>(clock, 0.0, day_s),
                            {.gravity_degree = 4, .drag_m2_per_kg = 0.05});
  const MotionState<Gcrs> low{{6378137.0 + 130e3, 0, 0}, {0, 5000, 5960}};
  const auto path = integrate_flight(forces, {.state = low, .from_s = 0, .to_s = day_s});
  ASSERT_EQ(path.ends.size(), 1u);
  EXPECT_EQ(path.ends[0].why, "it enters the Earth");
  EXPECT_TRUE(is_finite(path));
  const auto last = on_path(path, clock, path.segments.back().usable_stop_s);
  const SimTime time = sim_seconds(path.ends[0].at_s);
  const double height_m =
      geodetic_from_itrs(earth_orientation(clock, time).itrs_from_gcrs(time) * last.position_m)
          .height_m;
  EXPECT_NEAR(height_m, 0, 1.0);
  EXPECT_LT(norm(last.velocity_m_per_s), 700);  // the air has stopped it; the Earth turns below
  EXPECT_EQ(path.segments.back().usable_stop_s, path.ends[0].at_s);
}

TEST(NumericalFlight, ThatFallsFromRestAndPathsThroughTheEarthEndToo) {
  const Clock clock = any_clock();
  const FlightForces forces = point_mass(clock);
  for (const MotionState<Gcrs>& start :
       {MotionState<Gcrs>{{0, 0, 9e6}, {0, 0, 0}}, MotionState<Gcrs>{{4e7, 0, 0}, {0, 900, 0}},
        MotionState<Gcrs>{{7e6, 0, 0}, {-3e6, 0, 0}}}) {
    const auto path = integrate_flight(forces, {.state = start, .from_s = 0, .to_s = day_s});
    ASSERT_EQ(path.ends.size(), 1u);
    EXPECT_TRUE(is_finite(path));
  }
  const auto within =
      integrate_flight(forces, {.state = {{1e6, 0, 0}, {0, 1, 0}}, .from_s = 0, .to_s = 60});
  EXPECT_TRUE(within.segments.empty());
  EXPECT_EQ(within.ends.at(0).why, "it starts within the Earth");
}

}  // namespace
}  // namespace dmise
