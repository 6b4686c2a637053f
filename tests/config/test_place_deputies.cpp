#include "core/config/place_deputies.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "core/base/error.h"
#include "core/config/make_clock.h"
#include "core/config/objects/named_motion.h"
#include "core/config/scenario_text.h"
#include "core/config/stated_motion.h"
#include "core/orbit/motion.h"

namespace dmise {
namespace {

const std::string circle =
    "two_body: {semi_major_axis_m: 7178137, eccentricity: 0.0, inclination_deg: 98.6}";
const std::string sgp4 =
    "sgp4: {line1: \"1 25544U 98067A   18020.51782528  .00002182  00000-0  40768-4 0  9991\", "
    "line2: \"2 25544  51.6425  58.2840 0003417  29.1970  63.2050 15.54138710 95594\"}";
const std::string oem = "oem: " DMISE_SOURCE_DIR "/launch/scenarios/inspector.oem";
const std::string numerical =
    "numerical: {semi_major_axis_m: 7178137, eccentricity: 0.001, inclination_deg: 98.6}";
const std::string burning =
    numerical + ", manoeuvres: [{at_s: 30.5, delta_v_rtn_m_per_s: [0, 0, 3]}]";

Scenario placed(const std::string& chief, const std::string& motion, double tick_s = 5.0) {
  setenv("DMISE_HOME", DMISE_SOURCE_DIR, 1);
  return scenario_of_text("simulation: {start: 2018-01-21T00:15:00Z, duration_s: 60, tick_s: " +
                              std::to_string(tick_s) +
                              "}\nobjects:\n  - {name: near, motion: {proximity: {of: chief, " +
                              motion + "}}}\n  - {name: chief, motion: {" + chief + R"(}}
sensors:
  - {name: s, site: atlanta, camera: geo-watch, pointing: zenith, exposure_s: 1, cadence_s: 60}
)",
                          "s.yaml");
}

std::string refusal(const std::string& chief, const std::string& motion) {
  try {
    placed(chief, motion);
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "";
}

/// State of an object of the scenario's own in inertial axes: GCRS, or TEME of both.
MotionState<Gcrs> state(const Scenario& scenario, std::size_t object, double time_s) {
  const Clock clock = make_clock(scenario);
  const StatedMotion motion(scenario.own_objects.at(object).motion.model, clock);
  const FramedState at = motion.at(time_s);
  if (!std::holds_alternative<MotionState<Itrs>>(at)) {
    const auto [r, v] = without_frame(at);
    return {{r.x, r.y, r.z}, {v.x, v.y, v.z}};
  }
  const SimTime time = sim_seconds(time_s);
  return in_gcrs(at, earth_orientation(clock, time), time);
}

RelativeState relative(const Scenario& scenario, double time_s) {
  return relative_state(state(scenario, 1, time_s), state(scenario, 0, time_s));
}

// Whatever moves the chief, the deputy holds its place to 3 um + 1e-9 of the distance.
TEST(PlaceDeputies, HoldTheirPlaceNearAnyChief) {
  for (const std::string& chief : {circle, sgp4, oem, numerical, burning})
    for (const double distance_m : {0.5, 1e5}) {
      const Scenario s = placed(chief, "hold_rtn_m: [0, " + std::to_string(-distance_m) + ", 0]");
      for (const double t : {0.0, 1.234567, 29.9, 30.6, 60.0}) {
        const auto there = relative(s, t);
        EXPECT_LT(norm(there.position_m - Vec<Rtn>{0, -distance_m, 0}), 3e-6 + 1e-9 * distance_m)
            << chief << " " << t;
        // The axes of a perturbed chief turn about the radius too, by some 1e-6 rad/s, and SGP4's
        // velocity is not the slope of its path.
        const double off_m_per_s = (chief == sgp4 ? 0.02 : 1e-5) + 2e-6 * distance_m;
        EXPECT_LT(norm(there.velocity_m_per_s), off_m_per_s) << chief << " " << t;
      }
    }
}

TEST(PlaceDeputies, ApproachBreaksAtItsCorners) {
  const Scenario s = placed(circle,
                            "approach: {from_rtn_m: [-100, 0, 0], to_rtn_m: [-80, 0, 0], "
                            "speed_m_per_s: 1, at_s: 12.5}");
  for (const auto& [t, x] : {std::pair{0.0, -100.0},
                             {12.5, -100.0},
                             {13.5, -99.0},
                             {32.4, -80.1},
                             {32.6, -80.0},
                             {60.0, -80.0}})
    EXPECT_LT(norm(relative(s, t).position_m - Vec<Rtn>{x, 0, 0}), 1e-5) << t;
  EXPECT_NEAR(relative(s, 20.0).velocity_m_per_s.x, 1.0, 1e-4);
}

TEST(PlaceDeputies, FreeMotionNearAConicIsAConic) {
  const Scenario s =
      placed("two_body: {semi_major_axis_m: 26560000, eccentricity: 0.7, inclination_deg: 63}",
             "natural: {position_rtn_m: [100, 200, -50], velocity_rtn_m_per_s: [0.1, -0.2, 0.05]}");
  const auto start = deputy_state(state(s, 1, 0.0), {{100, 200, -50}, {0.1, -0.2, 0.05}});
  for (const double t : {0.0, 17.0, 60.0})
    EXPECT_LT(norm(state(s, 0, t).position_m - propagate_two_body(start, t).position_m), 1e-5);
}

TEST(PlaceDeputies, SayWhereAndWhy) {
  const std::string hold = "hold_rtn_m: [0, 100, 0]", ellipse = "circumnavigation: {radial_m: 50}";
  EXPECT_EQ(refusal("two_body: {semi_major_axis_m: 8e6, eccentricity: 0.05, inclination_deg: 9}",
                    ellipse),
            "s.yaml:3:38: objects[0].motion.proximity: the eccentricity of chief is 0.05, and "
            "Clohessy and Wiltshire's motion is about circles, up to 0.01: natural with dynamics: "
            "two_body takes any");
  EXPECT_EQ(refusal(circle, "hold_rtn_m: [0, 0, 0]"),
            "s.yaml:3:62: objects[0].motion.proximity.hold_rtn_m: is the place of the chief");
  EXPECT_EQ(refusal(circle,
                    "approach: {from_rtn_m: [0, -9, 0], to_rtn_m: [0, 9, 0], "
                    "speed_m_per_s: 1}"),
            "s.yaml:3:60: objects[0].motion.proximity.approach: leads through the chief");
  EXPECT_EQ(refusal(circle, "circumnavigation: {radial_m: 0}"),
            "s.yaml:3:68: objects[0].motion.proximity.circumnavigation: needs a radial_m or a "
            "normal_m above 0");
  EXPECT_EQ(refusal(circle, hold + ", " + ellipse),
            "s.yaml:3:38: objects[0].motion.proximity: give one of natural, circumnavigation, "
            "hold_rtn_m, approach");
  EXPECT_EQ(refusal("proximity: {of: near, " + hold + "}", hold),
            "s.yaml:3:43: objects[0].motion.proximity.of: it moves near another object itself, "
            "got chief");
  EXPECT_EQ(refusal("fixed: {gcrs_m: [1e7, 0, 0]}",
                    "natural: {position_rtn_m: [0, 9, 0], velocity_rtn_m_per_s: [0, 0, 0]}"),
            "s.yaml:3:38: objects[0].motion.proximity: natural: chief is in no orbit");
  const std::string unknown = refusal("node: gnc", hold);
  EXPECT_NE(unknown.find("gnc"), std::string::npos) << unknown;
}

TEST(PlaceDeputies, AnUnknownChiefIsRefusedWithTheNearestName) {
  try {
    scenario_of_text(R"(simulation: {start: 2018-01-21T00:15:00Z, duration_s: 60, tick_s: 5}
objects:
  - {catalogue: demo}
  - {name: near, motion: {proximity: {of: GOES 31, hold_rtn_m: [0, 9, 0]}}}
sensors:
  - {name: s, site: atlanta, camera: geo-watch, pointing: zenith, exposure_s: 1, cadence_s: 60}
)",
                     "s.yaml");
    FAIL();
  } catch (const ConfigError& e) {
    EXPECT_EQ(std::string(e.what()).find("s.yaml:4:43: objects[1].motion.proximity.of: no object "
                                         "has this name or number, did you mean GOES 1"),
              0u)
        << e.what();
  }
}

TEST(PlaceDeputies, WarnWhereFirstOrderOrATickIsTooCoarse) {
  const std::string far =
      "natural: {position_rtn_m: [5e+4, 0, 0], velocity_rtn_m_per_s: [0, -100, 0]";
  EXPECT_TRUE(placed(circle, far + "}").warnings.empty());
  const auto first_order = placed(circle, far + ", dynamics: clohessy_wiltshire}").warnings;
  EXPECT_TRUE(first_order.empty());  // a minute: metres of 50 km
  const std::string fast =
      "approach: {from_rtn_m: [0, -30, 0], to_rtn_m: [0, -20, 0], speed_m_per_s: 1}";
  EXPECT_TRUE(placed(circle, fast, 0.5).warnings.empty());
  const auto corners = placed(circle, fast, 5.0).warnings;
  ASSERT_EQ(corners.size(), 1u);
  EXPECT_EQ(corners[0],
            "s.yaml:3:38: objects[0].motion.proximity: approach: about the ticks at which it "
            "begins and ends places are up to 1.25 m off; a shorter tick_s lessens it");
}

}  // namespace
}  // namespace dmise
