#include "core/config/objects/object_config.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "core/base/error.h"
#include "core/base/files/json.h"
#include "core/base/units.h"
#include "core/config/yaml/yaml_reader.h"

namespace dmise {
namespace {

const Utc start{2458139.5, 0.0};

ObjectsConfig read(const std::string& text) {
  return read_objects(YamlMap(YamlValue::parse("objects:\n" + text, "s.yaml")).require("objects"),
                      start);
}

std::string complaint(const std::string& text) {
  try {
    read(text);
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "";
}

TEST(ObjectConfig, GpredictIsAnotherNameOfDemo) {
  setenv("DMISE_HOME", DMISE_SOURCE_DIR, 1);
  const ObjectSource demo = read("- {catalogue: demo}").catalogues.at(0),
                     gpredict = read("- {catalogue: gpredict}").catalogues.at(0);
  EXPECT_EQ(demo.path, DMISE_SOURCE_DIR "/launch/catalogues/demo.tle");
  EXPECT_EQ(gpredict.path, demo.path);
  EXPECT_EQ(gpredict.named, "demo");  // so that the run's digest is the same
}

OwnObject object(const std::string& motion, const std::string& rest = "") {
  return read("- {name: x, motion: " + motion + rest + "}").own.at(0);
}

template <class T>
T model(const OwnObject& object) {
  return std::get<T>(std::get<MotionModel>(object.motion.model));
}

TEST(ObjectConfig, TwoBodyByElementsOrByState) {
  // Circular speed at 7000 km: sqrt(3.986004415e14 / 7e6) = 7546.0533 m/s.
  const auto circular = model<TwoBodyMotion>(object(
      "{two_body: {semi_major_axis_m: 7e6, eccentricity: 0, inclination_deg: 90, raan_deg: 90}}"));
  EXPECT_NEAR(circular.state.position_m.y, 7e6, 1e-3);
  EXPECT_NEAR(circular.state.velocity_m_per_s.z, 7546.0533, 1e-4);
  // The epoch is the run's start: TAI - UTC = 37 s in 2018.
  EXPECT_NEAR(seconds_between({2458139.5, 0.0}, circular.epoch), 37.0, 1e-6);
  const auto by_state = model<TwoBodyMotion>(
      object("{two_body: {position_m: [7e6, 0, 0], velocity_m_per_s: [0, 7.5e3, 1],"
             " epoch: 2018-01-21T00:01:00Z}}"));
  EXPECT_EQ(by_state.state.velocity_m_per_s.y, 7500.0);
  EXPECT_NEAR(seconds_between({2458139.5, 0.0}, by_state.epoch), 97.0, 1e-6);
}

// Root of Kepler's equation at M = 90 deg, e = 0.2 by mpmath.findroot.
TEST(ObjectConfig, MeanAnomalyIsTurnedIntoTheTrueOne) {
  const auto mean =
      model<TwoBodyMotion>(object("{two_body: {periapsis_m: 8e6, eccentricity: 0.2, "
                                  "inclination_deg: 0, mean_anomaly_deg: 90}}"));
  const auto& r = mean.state.position_m;
  const double e_rad = 1.766960608;  // root of E - 0.2 sin E = pi / 2
  EXPECT_NEAR(e_rad - 0.2 * std::sin(e_rad), pi / 2, 1e-6);
  EXPECT_NEAR(norm(r), 1e7 * (1 - 0.2 * std::cos(e_rad)), 1e-2);
  EXPECT_NEAR(std::atan2(r.y, r.x), 2 * std::atan(std::sqrt(1.2 / 0.8) * std::tan(e_rad / 2)),
              1e-6);
}

TEST(ObjectConfig, FixedPlaces) {
  const auto pole = model<ConstantPosition<Itrs>>(
      object("{fixed: {latitude_deg: 90, longitude_deg: 0, height_m: 1000}}"));
  EXPECT_NEAR(pole.position_m.z, 6356752.3142 + 1000, 1e-3);  // WGS 84 polar radius
  EXPECT_EQ(model<ConstantPosition<Gcrs>>(object("{fixed: {gcrs_m: [1e7, 2, 3]}}")).position_m.y,
            2);
  EXPECT_EQ(model<ConstantPosition<Itrs>>(object("{fixed: {itrs_m: [1e7, 2, 3]}}")).position_m.z,
            3);
}

TEST(ObjectConfig, AttitudesOfEveryKind) {
  const auto attitude = [](const std::string& text) {
    return object("{fixed: {gcrs_m: [1e7, 0, 0]}}", ", attitude: " + text).attitude->model;
  };
  EXPECT_TRUE(std::holds_alternative<NadirAttitude>(attitude("nadir")));
  EXPECT_TRUE(std::holds_alternative<SunYawAttitude>(attitude("sun_tracking")));
  const auto inertial =
      std::get<InertialAttitude>(attitude("{inertial: {gcrs_from_body: [0.5, 0.5, 0.5, 0.5]}}"));
  EXPECT_NEAR((inertial.gcrs_from_body * Vec<Body>{1, 0, 0}).y, 1.0, 1e-15);  // x to y to z to x
  const auto spin = std::get<SpinningAttitude>(
      attitude("{spinning: {axis: [0, 0, 2], rate_rpm: 30, phase_deg: 90}}"));
  EXPECT_NEAR(spin.rate_rad_per_s, pi, 1e-15);
  const auto now = gcrs_from_body(spin, {.time_s = 0.0, .position_m = {1e7, 0, 0}});
  EXPECT_NEAR((now * Vec<Body>{1, 0, 0}).y, 1.0, 1e-15);  // a quarter turn about z
  const auto later = gcrs_from_body(spin, {.time_s = 0.5, .position_m = {1e7, 0, 0}});
  EXPECT_NEAR((later * Vec<Body>{1, 0, 0}).x, -1.0, 1e-15);
}

// A body that spins about the axis of its symmetry turns as `spinning` does.
TEST(ObjectConfig, ATumblingBodyTurnsByItsInertia) {
  const auto attitude = [](const std::string& text) {
    return object("{fixed: {gcrs_m: [1e7, 0, 0]}}", ", attitude: {tumbling: {" + text + "}}")
        .attitude->model;
  };
  const AttitudeScene later{.time_s = 7.0, .position_m = {1e7, 0, 0}};
  const auto turned =
      gcrs_from_body(attitude("inertia_kg_m2: [900, 8000, 8000], rate_deg_per_s: [12, 0, 0], "
                              "gcrs_from_body: [0.5, 0.5, 0.5, 0.5]"),
                     later);
  const auto spinning = gcrs_from_body(
      object("{fixed: {gcrs_m: [1e7, 0, 0]}}",
             ", attitude: {spinning: {axis: [1, 0, 0], rate_rpm: 2, gcrs_from_body: [0.5, 0.5, "
             "0.5, 0.5]}}")
          .attitude->model,
      later);
  for (const Vec<Body>& axis : {Vec<Body>{1, 0, 0}, {0, 1, 0}})
    EXPECT_LT(angle_rad(turned * axis, spinning * axis), 1e-14);
  const std::string fixed = "- {name: x, motion: {fixed: {gcrs_m: [1e7, 0, 0]}}, attitude: ";
  EXPECT_EQ(complaint(fixed + "{tumbling: {inertia_kg_m2: [1, 2, 3.5], rate_deg_per_s: [1, 0, "
                              "0]}}}"),
            "s.yaml:2:90: objects[0].attitude.tumbling.inertia_kg_m2: no body has these moments: "
            "one is beyond the sum of the others");
  EXPECT_EQ(complaint(fixed + "{tumbling: {inertia_kg_m2: [1, 0, 1], rate_deg_per_s: [1, 0, 0]}}}"),
            "s.yaml:2:94: objects[0].attitude.tumbling.inertia_kg_m2[1]: must be > 0, got 0");
  EXPECT_EQ(complaint(fixed + "{tumbling: {inertia_kg_m2: [1, 1, 1]}}}"),
            "s.yaml:2:74: objects[0].attitude.tumbling.rate_deg_per_s: is missing");
}

// Ticks of a minute are too long for a turn in a minute about a third axis.
TEST(ObjectConfig, TicksTooLongForATumblingBodyAreWarnedOf) {
  const AttitudeConfig attitude =
      *object("{fixed: {gcrs_m: [1e7, 0, 0]}}",
              ", attitude: {tumbling: {inertia_kg_m2: [900, 8000, 8000], rate_deg_per_s: [6, 6, "
              "0]}}")
           .attitude;
  EXPECT_FALSE(coarse_tick_warning(attitude, 1.0));
  const std::string warning = coarse_tick_warning(attitude, 20.0).value_or("");
  EXPECT_NE(warning.find("objects[0].attitude: between ticks it is up to "), std::string::npos)
      << warning;
}

TEST(ObjectConfig, ObjectsWithoutANumberGetOneInOrder) {
  const auto own =
      read(
          "- {name: a, motion: {fixed: {gcrs_m: [1e7, 0, 0]}}}\n"
          "- {name: b, catalogue_number: 990000001, motion: {fixed: {gcrs_m: [1e7, 0, 0]}}}\n"
          "- {name: c, motion: {fixed: {gcrs_m: [1e7, 0, 0]}}}\n")
          .own;
  EXPECT_EQ(own[0].catalogue_number, 990000002u);
  EXPECT_EQ(own[1].catalogue_number, 990000001u);
  EXPECT_EQ(own[2].catalogue_number, 990000003u);
}

TEST(ObjectConfig, LightOfAReentryIsByHeight) {
  const std::string object = "- {name: x, motion: {fixed: {gcrs_m: [1e7, 0, 0]}}, reentry: ";
  const auto light =
      read(object + "{height_m: [5.0e+4, 9.0e+4], magnitude: [-3, 2.5]}}").own[0].reentry;
  EXPECT_EQ(light, (ReentryLight{{5e4, 9e4}, {-3, 2.5}, 100e3}));
  EXPECT_EQ(
      complaint(object + "{height_m: [9.0e+4, 9.0e+4], magnitude: [-3, 2.5]}}"),
      "s.yaml:2:82: objects[0].reentry.height_m[1]: must be above the one before, got 9.0e+4");
  EXPECT_EQ(complaint(object + "{height_m: [5.0e+4, 9.0e+4], magnitude: [-3, 2, 1]}}"),
            "s.yaml:2:102: objects[0].reentry.magnitude: must have one for each height");
  for (const std::string few : {"[]", "[5.0e+4]"})
    EXPECT_EQ(complaint(object + "{height_m: " + few + ", magnitude: " + few + "}}"),
              "s.yaml:2:73: objects[0].reentry.height_m: must have two heights or more");
}

TEST(ObjectConfig, SaysWhereAndWhy) {
  const std::string fixed = "motion: {fixed: {gcrs_m: [1e7, 0, 0]}}";
  EXPECT_EQ(complaint("- {name: x}"), "s.yaml:2:3: objects[0].motion: is missing");
  EXPECT_EQ(
      complaint("- {radius_m: 2}"),
      "s.yaml:2:3: objects[0]: needs a catalogue, a walker, a train, a breakup, a population, "
      "or a name and a motion");
  EXPECT_EQ(complaint("- {name: x, " + fixed + ", albdo: 1}"),
            "s.yaml:2:53: objects[0].albdo: unknown key, did you mean albedo?");
  EXPECT_EQ(complaint("- {name: x, motion: {flying: {}}}"),
            "s.yaml:2:22: objects[0].motion.flying: unknown key");
  EXPECT_EQ(
      complaint("- {name: x, motion: {}}"),
      "s.yaml:2:21: objects[0].motion: give one of two_body, numerical, oem, sp3, fixed, track, "
      "enu, sgp4, proximity, node");
  EXPECT_EQ(complaint("- {name: x, motion: {track: none.csv}}"),
            "s.yaml:2:29: objects[0].motion.track: there is no such file, got none.csv");
  EXPECT_EQ(complaint("- {name: x, motion: {oem: none.oem}}"),
            "s.yaml:2:27: objects[0].motion.oem: there is no such file, got none.oem");
  EXPECT_EQ(complaint("- {name: x, motion: {sp3: none.sp3, satellite: L71}}"),
            "s.yaml:2:27: objects[0].motion.sp3: there is no such file, got none.sp3");
  EXPECT_EQ(complaint("- {name: x, motion: {oem: none.oem, satellite: L71}}"),
            "s.yaml:2:48: objects[0].motion.satellite: goes with sp3");
  EXPECT_EQ(
      complaint("- {name: x, motion: {satellite: L71}}"),
      "s.yaml:2:21: objects[0].motion: give one of two_body, numerical, oem, sp3, fixed, track, "
      "enu, sgp4, proximity, node");
  EXPECT_EQ(complaint("- {name: x, motion: {fixed: {itrs_m: [1, 2]}}}"),
            "s.yaml:2:38: objects[0].motion.fixed.itrs_m: must be a list of 3 numbers, got a list");
  EXPECT_EQ(complaint("- {name: x, motion: {fixed: {itrs_m: [1, 2, 3]}}}"),
            "s.yaml:2:38: objects[0].motion.fixed.itrs_m: is inside the Earth, got a list");
  EXPECT_EQ(
      complaint("- {name: x, motion: {fixed: {latitude_deg: 91, longitude_deg: 0, height_m: 1}}}"),
      "s.yaml:2:44: objects[0].motion.fixed.latitude_deg: must be <= 90, got 91");
  EXPECT_EQ(
      complaint("- {name: x, motion: {two_body: {semi_major_axis_m: 7e6, eccentricity: 1, "
                "inclination_deg: 0}}}"),
      "s.yaml:2:71: objects[0].motion.two_body.eccentricity: must be < 1 with semi_major_axis_m; "
      "open orbits need periapsis_m, got 1");
  EXPECT_EQ(complaint("- {name: x, motion: {two_body: {periapsis_m: 7e6, eccentricity: 2, "
                      "inclination_deg: 0, true_anomaly_deg: 121}}}"),
            "s.yaml:2:106: objects[0].motion.two_body.true_anomaly_deg: must be inside the "
            "asymptotes, got 121");
  EXPECT_EQ(complaint("- {name: x, motion: {sgp4: {line1: abc, line2: def}}}").substr(0, 37),
            "s.yaml:2:28: objects[0].motion.sgp4: ");
  EXPECT_EQ(complaint("- {name: x, " + fixed + ", attitude: nadr}"),
            "s.yaml:2:63: objects[0].attitude: must be one of nadir, sun_tracking, did you mean "
            "nadir?, got nadr");
  EXPECT_EQ(
      complaint("- {name: x, " + fixed + ", attitude: {inertial: {gcrs_from_body: [0, 0, 0, 0]}}}"),
      "s.yaml:2:91: objects[0].attitude.inertial.gcrs_from_body: must be a unit quaternion [w, x, "
      "y, "
      "z], its length is 0.000000");
  EXPECT_EQ(complaint("- {name: x, " + fixed + ", panel: {hinge: [0, 1, 0]}}"),
            "s.yaml:2:60: objects[0].panel: needs an attitude");
  EXPECT_EQ(complaint("- {name: x, " + fixed + "}\n- {name: x, " + fixed + "}"),
            "s.yaml:3:10: objects[1].name: another object has this name, got x");
}

const std::string sp3 = DMISE_SOURCE_DIR "/tests/docs/every_key/orbit.sp3";

TEST(ObjectConfig, AnSp3IsTheTrajectoryOfOneOfItsSatellites) {
  const OwnObject own = object("{sp3: " + sp3 + ", satellite: g05}");
  EXPECT_EQ(own.motion.satellite, "G05");
  EXPECT_EQ(own.motion.trajectory_path, sp3);
  EXPECT_EQ(model<Trajectory>(own).segments.at(0).object_name, "G05");
  EXPECT_EQ(complaint("- {name: x, motion: {sp3: " + sp3 + ", satellite: L99}}"),
            sp3 + ": has no satellite L99, only G05, L71, L72");
  EXPECT_EQ(complaint("- {name: x, motion: {sp3: " + sp3 + "}}"),
            sp3 + ": is of several satellites, G05, L71, L72: name one");
}

std::string json_of(const std::string& text) {
  JsonWriter writer;
  const auto objects = read(text);
  writer.begin_object();
  write_objects(writer, objects.catalogues, objects.own);
  return writer.end_object().take();
}

TEST(ObjectConfig, TheSatelliteOfAnSp3ShowsInThePhysicsDigest) {
  const auto of = [](const std::string& satellite) {
    return json_of("- {name: x, motion: {sp3: " + sp3 + ", satellite: " + satellite + "}}");
  };
  EXPECT_NE(of("G05"), of("L71"));
  EXPECT_EQ(of("G05"), of("g05"));
}

// What changes an object's motion or attitude changes the run's digest.
TEST(ObjectConfig, EveryChangeShowsInThePhysicsDigest) {
  const std::string good =
      "- {name: x, motion: {two_body: {semi_major_axis_m: 7e6, eccentricity: 0.1, "
      "inclination_deg: 10}}, attitude: {spinning: {rate_rpm: 3}}, panel: {hinge: [0, 1, 0]}}";
  for (const auto& [what, with] : {std::pair{"7e6", "7.1e6"},
                                   {"0.1", "0.2"},
                                   {"rate_rpm: 3", "rate_rpm: 4"},
                                   {"x", "y"},
                                   {"[0, 1, 0]", "[1, 0, 0]"},
                                   {"spinning: {rate", "spinning: {phase_deg: 1, rate"}}) {
    std::string other = good;
    other.replace(other.find(what), std::string(what).size(), with);
    EXPECT_NE(json_of(good), json_of(other)) << with;
  }
  EXPECT_EQ(json_of(good), json_of(good));
  const std::string tumbling =
      "- {name: x, motion: {fixed: {gcrs_m: [1e7, 0, 0]}}, attitude: {tumbling: {inertia_kg_m2: "
      "[1, "
      "2, 2.5], rate_deg_per_s: [1, 2, 3]}}}";
  for (const auto& [what, with] : {std::pair{"2.5", "2.6"}, {"[1, 2, 3]", "[1, 2, 4]"}}) {
    std::string other = tumbling;
    other.replace(other.find(what), std::string(what).size(), with);
    EXPECT_NE(json_of(tumbling), json_of(other)) << with;
  }
}

}  // namespace
}  // namespace dmise
