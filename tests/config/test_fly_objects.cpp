#include "core/config/fly_objects.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "core/base/error.h"
#include "core/config/make_clock.h"
#include "core/config/scenario_text.h"
#include "core/orbit/elements/tle.h"
#include "core/orbit/motion.h"
#include "core/orbit/sgp4/sgp4_batch.h"
#include "core/orbit/sp3.h"
#include "core/orbit/two_body.h"
#include "tests/support/data.h"
#include "tests/support/flights.h"

namespace dmise {
namespace {

const std::string goes_1 = "1 29155U 06018A   18020.76993589 -.00000277  00000-0  00000+0 0  9990";
const std::string goes_2 = "2 29155   0.3033 103.4554 0011344  94.0749 132.0880  1.00469224 42737";

Scenario flown(const std::string& motion, const std::string& start = "2018-01-21T00:15:00Z") {
  setenv("DMISE_HOME", DMISE_SOURCE_DIR, 1);
  return scenario_of_text("simulation: {start: " + start + R"(, duration_s: 600, tick_s: 10}
objects:
  - {name: x, motion: {)" + motion +
                              R"(}}
sensors:
  - {name: s, site: atlanta, camera: geo-watch, pointing: zenith, exposure_s: 1, cadence_s: 60}
)",
                          "s.yaml");
}

std::string refusal(const std::string& motion) {
  try {
    flown(motion);
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "";
}

const Trajectory& path_of(const Scenario& scenario) {
  return std::get<Trajectory>(std::get<MotionModel>(scenario.own_objects.at(0).motion.model));
}

MotionState<Gcrs> gcrs_at(const Scenario& scenario, double time_s) {
  const Clock clock = make_clock(scenario);
  const SimTime time = sim_seconds(time_s);
  return in_gcrs(state_at(path_of(scenario), clock.tai(time)), earth_orientation(clock, time),
                 time);
}

const std::string state = "position_m: [7e6, 0, 0], velocity_m_per_s: [0, 5e3, 5.6e3]";
const MotionState<Gcrs> same_state{{7e6, 0, 0}, {0, 5e3, 5.6e3}};
const std::string alone = ", forces: {gravity_degree: 0, sun_moon: off}";

TEST(FlyObjects, NumericalMotionOfAPointMassIsTheConicAlsoBeyondTheRun) {
  const Scenario s = flown("numerical: {" + state + ", epoch: 2018-01-21T00:10:00Z}" + alone);
  for (const double t : {-200.0, -1.0, 0.0, 33.3, 600.0, 700.0})
    EXPECT_LT(norm(gcrs_at(s, t).position_m - propagate_two_body(same_state, t + 300).position_m),
              1e-3)
        << t;
}

// Reference: python-sgp4's equal, core/orbit/sgp4.
TEST(FlyObjects, ElementsMoveBySgp4UntilTheManoeuvreAndGoOnFromThere) {
  const Scenario s = flown("sgp4: {line1: \"" + goes_1 + "\", line2: \"" + goes_2 +
                           "\"}, manoeuvres: [{at_s: 300, delta_v_rtn_m_per_s: [0, 0, 4]}]");
  EXPECT_EQ(s.own_objects[0].catalogue_number, 29155u);
  const Clock clock = make_clock(s);
  const MeanElements elements = parse_tle(goes_1, goes_2);
  const Sgp4Batch batch(std::span(&elements, 1));
  for (const double t : {-100.0, 0.0, 111.1, 299.9}) {
    const Utc utc = clock.utc(sim_seconds(t));
    std::array<double, 3> r{}, v{};
    std::array<std::uint8_t, 1> code{};
    batch.propagate(utc.jd1, utc.jd2, r, v, code);
    const auto there = std::get<MotionState<Teme>>(state_at(path_of(s), clock.tai(sim_seconds(t))));
    EXPECT_LT(norm(there.position_m - Vec<Teme>{r[0], r[1], r[2]}), 1e-4) << t;
    EXPECT_LT(norm(there.velocity_m_per_s - Vec<Teme>{v[0], v[1], v[2]}), 1e-6) << t;
  }
  const auto before = gcrs_at(s, 299.999), after = gcrs_at(s, 300);
  EXPECT_LT(norm(after.position_m - before.position_m), 4.0);
  EXPECT_NEAR(norm(after.velocity_m_per_s - before.velocity_m_per_s), 4, 0.01);
}

TEST(FlyObjects, AnSp3IsThatUntilTheManoeuvre) {
  const std::string file = DMISE_SOURCE_DIR "/tests/docs/every_key/orbit.sp3";
  const Trajectory orbit = read_sp3(file, "L71");
  const TrajectorySpan span = span_of(orbit);
  const std::string start = span_text(orbit).substr(0, 19) + "Z";
  const Scenario s = flown("sp3: " + file +
                               ", satellite: L71, manoeuvres: [{at_s: 330, "
                               "delta_v_rtn_m_per_s: [0, 10, 0]}]",
                           start);
  const Clock clock = make_clock(s);
  ASSERT_GT(seconds_between(clock.tai({0}), span.stop), 330);
  for (const double t : {5.0, 100.0, 329.0}) {
    const Tai tai = clock.tai(sim_seconds(t));
    const auto stated = std::get<MotionState<Itrs>>(state_at(orbit, tai));
    const auto there = std::get<MotionState<Itrs>>(state_at(path_of(s), tai));
    EXPECT_LT(norm(there.position_m - stated.position_m), 1e-5);
  }
  EXPECT_NEAR(norm(gcrs_at(s, 330).velocity_m_per_s - gcrs_at(s, 329.9999).velocity_m_per_s), 10,
              0.01);
}

TEST(FlyObjects, AConicWithAZeroManoeuvreStaysAConicForAPointMass) {
  const Scenario s = flown("two_body: {" + state +
                           "}, manoeuvres: [{at_s: 200, "
                           "delta_v_rtn_m_per_s: [0, 0, 0]}]" +
                           alone);
  for (const double t : {-100.0, 10.0, 199.0, 200.0, 599.0})
    EXPECT_LT(norm(gcrs_at(s, t).position_m - propagate_two_body(same_state, t).position_m), 1e-3);
}

// Reference: tests/reference/flight_with_orekit.py, after 6 h.
TEST(FlyObjects, AScenarioSaysWhatOrekitFlies) {
  const std::string finals = test::data_path("eop/finals2000A.all.gz");
  if (!test::exists(finals)) {
    ASSERT_EQ(std::getenv("DMISE_DATA"), nullptr) << finals;
    GTEST_SKIP() << "no " << finals;
  }
  setenv("DMISE_HOME", DMISE_SOURCE_DIR, 1);
  const Scenario s = scenario_of_text(
      "simulation: {start: 2018-12-24T22:00:00Z, duration_s: 21600, tick_s: 60, interpolation: 7, "
      "earth_orientation: " +
          finals + R"(}
objects:
  - name: x
    motion:
      numerical: {position_m: [6878137.0, 0, 0], velocity_m_per_s: [0, -944.0, 7553.0]}
      forces: {gravity_degree: 20, area_to_mass_m2_per_kg: 0.01, drag_coefficient: 2.2, radiation_coefficient: 1.3}
sensors:
  - {name: s, site: atlanta, camera: geo-watch, pointing: zenith, exposure_s: 1, cadence_s: 600}
)",
      "s.yaml");
  const auto& flight = *std::ranges::find(test::orekit_flights, std::string("low"),
                                          [](const auto& f) { return std::string(f.name); });
  EXPECT_LT(norm(gcrs_at(s, 21600).position_m - flight.every_six_hours[0].position_m), 0.5);
}

// A manoeuvre before the run, and one within it.
TEST(FlyObjects, ManoeuvresBeforeTheRunCount) {
  const std::string motion = "numerical: {" + state + ", epoch: 2018-01-21T00:00:00Z}" + alone +
                             ", manoeuvres: [{at_s: -600, delta_v_rtn_m_per_s: [7, 0, 0]}]";
  const Scenario s = flown(motion);
  MotionState<Gcrs> there = propagate_two_body(same_state, 300);
  there.velocity_m_per_s += unit(there.position_m) * 7;
  EXPECT_LT(norm(gcrs_at(s, 100).position_m - propagate_two_body(there, 700).position_m), 1e-3);
}

TEST(FlyObjects, StatesAreTheSameBytesInAnyScenarioThatSaysTheSame) {
  const std::string motion = "numerical: {" + state + "}, forces: {area_to_mass_m2_per_kg: 0.02}";
  const Scenario one = flown(motion), other = flown(motion);
  const Clock clock = make_clock(one);
  std::vector<FramedState> forwards, back;
  for (int i = 0; i <= 100; ++i)
    forwards.push_back(state_at(path_of(one), clock.tai(sim_seconds(6.0 * i))));
  for (int i = 100; i >= 0; --i)
    back.push_back(state_at(path_of(other), clock.tai(sim_seconds(6.0 * i))));
  for (std::size_t i = 0; i <= 100; ++i) {
    const auto &a = std::get<MotionState<Gcrs>>(forwards[i]),
               &b = std::get<MotionState<Gcrs>>(back[100 - i]);
    EXPECT_EQ(a.position_m, b.position_m);
    EXPECT_EQ(a.velocity_m_per_s, b.velocity_m_per_s);
  }
  EXPECT_NE(physics_json(one), physics_json(flown("numerical: {" + state + "}")));
}

// Falls 122 km under 9.4 - 1.4 m/s^2 in 174 s. Before the run it rose from the ground.
TEST(FlyObjects, OneThatFallsSaysWhen) {
  const Scenario s = flown("numerical: {position_m: [6.5e6, 0, 0], velocity_m_per_s: [0, 3e3, 0]}");
  const std::string& end = s.own_objects[0].motion.flight->end;
  EXPECT_EQ(end.substr(0, 41), "it enters the Earth at 2018-01-21T00:17:5") << end;
  EXPECT_NEAR(path_of(s).segments.back().usable_stop_s, 174, 5);
  EXPECT_NEAR(path_of(s).segments.front().usable_start_s, -174, 5);
}

TEST(FlyObjects, AJumpWithinALongTickIsNoted) {
  const auto warnings = [](const std::string& delta_v) {
    return flown("numerical: {" + state + "}, manoeuvres: [{at_s: 77, delta_v_rtn_m_per_s: [0, " +
                 delta_v + ", 0]}]")
        .warnings;
  };
  EXPECT_TRUE(warnings("0.3").empty());
  ASSERT_EQ(warnings("8").size(), 1u);
  EXPECT_EQ(
      warnings("8")[0],
      "s.yaml:3:23: objects[0].motion: manoeuvres: about the tick of the change of 8 m/s places "
      "are up to 20 m off; a shorter tick_s lessens it");
}

TEST(FlyObjects, RefusesWhatHasNoPath) {
  const std::string where = "s.yaml:3:23: objects[0].motion: ";
  EXPECT_EQ(refusal("numerical: {" + state + ", epoch: 2017-01-01T00:00:00Z}"),
            where + "numerical: its epoch must be within 100 days of the run");
  EXPECT_EQ(refusal("numerical: {" + state +
                    "}, manoeuvres: [{at_s: -1, delta_v_rtn_m_per_s: [1, 0, 0]}]"),
            where + "manoeuvres: the first is before the epoch of the state");
  EXPECT_EQ(refusal("numerical: {position_m: [6.5e6, 0, 0], velocity_m_per_s: [0, 3e3, 0], "
                    "epoch: 2018-01-20T22:00:00Z}")
                .substr(0, where.size() + 66),
            where + "x has no path in the run: it enters the Earth at 2018-01-20T22:02:");
  const std::string file = DMISE_SOURCE_DIR "/tests/docs/every_key/orbit.sp3";
  EXPECT_EQ(refusal("sp3: " + file +
                    ", satellite: L71, manoeuvres: [{at_s: 3e6, delta_v_rtn_m_per_s: "
                    "[0, 10, 0]}]")
                .substr(0, where.size() + 39),
            where + "has no state at its first manoeuvre: " + file.substr(0, 2));
}

}  // namespace
}  // namespace dmise
