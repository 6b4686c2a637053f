#include "core/config/scenario.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <set>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/sky/places/place_effects.h"

namespace dmise {
namespace {

const std::string gcvs_of_one_star = DMISE_SOURCE_DIR "/tests/docs/every_key/gcvs.txt";
const std::string good =
    R"(simulation: {start: 2018-01-21T00:30:00Z, duration_s: 120, tick_s: 5, seed: 1}
sensors:
  - name: atlanta
    site: {latitude_deg: 33.777, longitude_deg: -84.398, height_m: 300}
    camera: omnissa
    pointing: zenith
    exposure_s: 20
    cadence_s: 30
)";

class ScenarioFile : public testing::Test {
 protected:
  std::string path = (std::filesystem::path(testing::TempDir()) / "scenario.yaml").string();
  void SetUp() override { setenv("DMISE_HOME", DMISE_SOURCE_DIR, 1); }
  void TearDown() override { std::remove(path.c_str()); }

  Scenario load(const std::string& text) {
    std::ofstream(path) << text;
    return load_scenario(path);
  }
  std::string complaint(std::string text, const std::string& what, const std::string& with) {
    text.replace(text.find(what), what.size(), with);
    try {
      load(text);
    } catch (const ConfigError& e) {
      std::string message = e.what();
      if (message.starts_with(path)) message.erase(0, path.size() + 1);
      return message;
    }
    return "";
  }
};

TEST_F(ScenarioFile, StarsGoOnWhereACatalogueEnds) {
  const auto to_v_mag = [&](const std::string& more) {
    return load(good + "stars: {catalogue: kstars" + more + "}\n").synthetic_stars_to_v_mag;
  };
  EXPECT_FALSE(to_v_mag(""));
  EXPECT_EQ(to_v_mag(", synthetic_to: limit"), std::numeric_limits<double>::infinity());
  EXPECT_EQ(to_v_mag(", synthetic_to: 17"), 17.0);
  EXPECT_FALSE(to_v_mag(", synthetic_to: off"));
  EXPECT_FALSE(load(good).synthetic_stars_to_v_mag);
  for (const char* wrong : {"22", "deep", "[1]"}) {
    const std::string text = good + "stars: {catalogue: kstars, synthetic_to: " + wrong + "}\n";
    const std::string message = complaint(text, "seed: 1", "seed: 2");
    EXPECT_TRUE(message.starts_with("9:42: stars.synthetic_to: must be ")) << message;
  }
}

TEST_F(ScenarioFile, VariableStarsAreInTheDigestAlone) {
  const std::string stars = good + "stars: {catalogue: kstars", file = gcvs_of_one_star;
  const Scenario with = load(stars + ", variables: " + file + "}\n"), without = load(stars + "}\n");
  EXPECT_EQ(with.star_variables_path, file);
  EXPECT_NE(physics_json(with), physics_json(without));
  EXPECT_EQ(physics_json(without).find("variables"), std::string::npos);
  EXPECT_TRUE(complaint(stars + ", variables: absent.txt}\n", "seed: 1", "seed: 2")
                  .starts_with("9:39: stars.variables: there is no such file"));
}

TEST_F(ScenarioFile, ResolvesPresetsAndDefaults) {
  const auto scenario = load(good);
  ASSERT_EQ(scenario.sensors.size(), 1u);
  const auto& sensor = scenario.sensors[0];
  EXPECT_EQ(scenario.last_tick(), 24);
  EXPECT_EQ(sensor.camera.optics.columns, 3326);
  // 90 deg across 3326 pixels of 5.4 um.
  EXPECT_NEAR(sensor.camera.optics.focal_length_m, 8.98e-3, 0.005e-3);
  EXPECT_EQ(sensor.tracking, Tracking::fixed);
  EXPECT_EQ(sensor.sky.preset, "dark");
  EXPECT_EQ(sensor.sky.zenith_mag_per_arcsec2, 21.9);
  EXPECT_EQ(physics_json(scenario), physics_json(load(good)));
}

TEST_F(ScenarioFile, SaysWhereAndWhy) {
  EXPECT_EQ(complaint(good, "exposure_s: 20", "exposure_s: -1"),
            "7:17: sensors[0].exposure_s: must be >= 1e-06, got -1");
  EXPECT_EQ(complaint(good, "exposure_s: 20", "exposur_s: 20"),
            "7:5: sensors[0].exposur_s: unknown key, did you mean exposure_s?");
  EXPECT_EQ(complaint(good, "    exposure_s: 20\n", ""), "3:5: sensors[0].exposure_s: is missing");
  EXPECT_EQ(complaint(good, "cadence_s: 30", "cadence_s: 30\n    roll_dg: 2"),
            "9:5: sensors[0].roll_dg: unknown key");
  EXPECT_EQ(complaint(good, "latitude_deg: 33.777", "latitude_deg: 133.777"),
            "4:26: sensors[0].site.latitude_deg: must be <= 90, got 133.777");
  EXPECT_EQ(
      complaint(good, "2018-01-21T00:30:00Z", "yesterday"),
      "1:21: simulation.start: must be a UTC time such as 2018-01-21T00:30:00Z, got yesterday");
  EXPECT_TRUE(complaint(good, "omnissa", "omnisa")
                  .starts_with("5:13: sensors[0].camera: no such camera, did you mean omnissa?"));
  EXPECT_EQ(complaint(good, "exposure_s: 20", "exposure_s: 40"),
            "7:17: sensors[0].exposure_s: must be <= cadence_s, got 40");
  EXPECT_EQ(complaint(good, "cadence_s: 30", "cadence_s: 30\n    mask_deg: 95"),
            "9:15: sensors[0].mask_deg: must be <= 89, got 95");
  EXPECT_EQ(complaint(good, "duration_s: 120", "duration_s: 10"),
            "7:17: sensors[0].exposure_s: the first exposure ends after the run does, got 20");
}

// What a run of 3 ticks of 7 s would last is not what the scenario says.
TEST_F(ScenarioFile, RefusesADurationThatIsNoWholeNumberOfTicks) {
  const auto asked = [&](const std::string& duration_s, const std::string& tick_s) {
    std::string text = good;
    text.replace(text.find("tick_s: 5"), 9, "tick_s: " + tick_s);
    return complaint(text, "duration_s: 120", "duration_s: " + duration_s);
  };
  EXPECT_EQ(asked("50", "7"),
            "1:55: simulation.duration_s: must be a whole number of ticks (tick_s: 7): 49 or 56, "
            "got 50");
  EXPECT_EQ(
      asked("50", "60"),
      "1:55: simulation.duration_s: must be a whole number of ticks (tick_s: 60): 60, got 50");
  EXPECT_EQ(asked("30.1", "0.2"),
            "1:55: simulation.duration_s: must be a whole number of ticks (tick_s: 0.2): 30 or "
            "30.2, got 30.1");
  // Both are counted in nanoseconds, whatever their binary fractions.
  for (const auto& [duration_s, tick_s] : {std::pair{"49", "7"}, {"30.3", "0.1"}, {"60", "0.3"}}) {
    std::string text = good;
    text.replace(text.find("tick_s: 5"), 9, std::string("tick_s: ") + tick_s);
    text.replace(text.find("duration_s: 120"), 15, std::string("duration_s: ") + duration_s);
    const Scenario scenario = load(text);
    EXPECT_EQ(scenario.time_of(scenario.last_tick()), scenario.duration) << duration_s;
  }
}

// eraEpv00 covers 1900 to 2100; UTC runs in whole leap seconds from 1972 on (IERS Bulletin C).
TEST_F(ScenarioFile, RefusesARunBeyondTheEphemerisOrBeforeLeapSeconds) {
  EXPECT_EQ(complaint(good, "2018-01-21T00:30:00Z", "2150-01-21T00:30:00Z"),
            "1:21: simulation.start: must be within 1900 to 2100, the years of the ephemeris, got "
            "2150-01-21T00:30:00Z");
  EXPECT_EQ(complaint(good, "2018-01-21T00:30:00Z, duration_s: 120",
                      "2099-12-31T00:30:00Z, duration_s: 8640000"),
            "1:55: simulation.duration_s: the run must end within 1900 to 2100, the years of the "
            "ephemeris, got 8640000");
  EXPECT_EQ(complaint(good, "2018-01-21T00:30:00Z", "1971-12-31T00:30:00Z"),
            "1:21: simulation.start: must not be before 1972, when UTC was not yet whole seconds "
            "from TAI, got 1971-12-31T00:30:00Z");
}

TEST_F(ScenarioFile, SeeingIsInTheDigest) {
  Scenario scenario = load(good);
  std::set<std::string> texts{physics_json(scenario)};
  for (const double r0_m : {0.1, 0.2}) {
    scenario.sensors[0].seeing = SensorSeeing{.r0_m = r0_m};
    texts.insert(physics_json(scenario));
  }
  EXPECT_EQ(texts.size(), 3u);
}

TEST_F(ScenarioFile, EffectsThatAreSwitchedAreInTheDigest) {
  std::set<std::string> texts{physics_json(load(good))};
  for (const char* effects : {"stars: off", "stars: on", "light_time: off", "light_time: on"})
    texts.insert(physics_json(load(good + "effects: {" + effects + "}\n")));
  EXPECT_EQ(texts.size(), 5u);
}

// 10 min of cubic put objects kilometres away: 2.5 km against ticks of 5 s.
TEST_F(ScenarioFile, RefusesTicksBetweenWhichObjectsAreMetresOff) {
  const std::string own_object =
      "{name: x, motion: {fixed: {latitude_deg: 0, longitude_deg: -75.3, height_m: 35786000}}}";
  const std::string long_ticks = "simulation: {start: 2018-01-21T00:30:00Z, duration_s: 7200, ";
  const auto simulation = [&](const std::string& rest) {
    return long_ticks + rest + "}\nobjects: [" + own_object + "]\n" +
           good.substr(good.find("sensors"));
  };
  EXPECT_EQ(complaint(simulation("tick_s: 600"), "600", "600"),
            "1:69: simulation.tick_s: objects between ticks longer than 60 s are metres off by "
            "interpolation of order 3 (simulation.interpolation: 5 allows 120 s, 7 180 s, in runs "
            "of that many ticks), got 600");
  EXPECT_EQ(load(simulation("tick_s: 60")).interpolation, HermiteOrder::cubic);
  EXPECT_EQ(load(simulation("tick_s: 120, interpolation: 5")).interpolation, HermiteOrder::quintic);
  EXPECT_EQ(load(simulation("tick_s: 180, interpolation: 7")).interpolation, HermiteOrder::septic);
  EXPECT_NE(complaint(simulation("tick_s: 200, interpolation: 7"), "200", "200"), "");
  EXPECT_NE(physics_json(load(simulation("tick_s: 60"))),
            physics_json(load(simulation("tick_s: 60, interpolation: 5"))));
  EXPECT_TRUE(complaint(simulation("tick_s: 60, interpolation: 4"), "4", "4")
                  .find("simulation.interpolation: must be one of 3, 5, 7, got 4") !=
              std::string::npos);
  EXPECT_EQ(load(simulation("tick_s: 120")).interpolation, HermiteOrder::quintic);
  // Without objects nothing is interpolated.
  EXPECT_NO_THROW(load(long_ticks + "tick_s: 600}\n" + good.substr(good.find("sensors"))));
}

// Worst errors by `dmise bench interpolation` at ticks of 60 s: 1.3 m of order 3, which 200 km away
// are 0.6 px of a telescope of 2.3 arcsec a pixel and 0.01 px of an all-sky camera; 6.5 mm of order
// 5.
TEST_F(ScenarioFile, ObjectsAreInterpolatedAsTheTightestPositionBudgetAsks) {
  const auto order = [&](const char* tick_s, const std::string& camera, const char* accuracy) {
    std::string sensors = good.substr(good.find("sensors"));
    const auto at = sensors.find("camera: ") + 8;
    sensors.replace(at, sensors.find_first_of(",}\n", at) - at, camera);
    return load(std::string("accuracy: ") + accuracy +
                "\nsimulation: {start: 2018-01-21T00:30:00Z, duration_s: 7200, tick_s: " + tick_s +
                "}\nobjects: [{name: x, motion: {fixed: {latitude_deg: 0, longitude_deg: -75.3, "
                "height_m: 35786000}}}]\n" +
                sensors)
        .interpolation;
  };
  EXPECT_EQ(order("60", "omnissa", "standard"), HermiteOrder::cubic);
  EXPECT_EQ(order("60", "raven", "standard"), HermiteOrder::quintic);
  EXPECT_EQ(order("60", "raven", "off"), HermiteOrder::cubic);
  EXPECT_EQ(order("60", "raven", "{position_px: 4}"), HermiteOrder::cubic);
  EXPECT_EQ(order("5", "raven", "standard"), HermiteOrder::cubic);
}

TEST_F(ScenarioFile, RefusesTwoNodesOfOneName) {
  const std::string second = good.substr(good.find("  - name"));
  EXPECT_EQ(complaint(good + second, "seed: 1", "seed: 1"),
            "9:11: sensors[1].name: another node has this name, got atlanta");
  EXPECT_EQ(complaint(good, "name: atlanta", "name: time-master"),
            "3:11: sensors[0].name: another node has this name, got time-master");
}

TEST_F(ScenarioFile, SwitchesEffectsForAllAndForOne) {
  const auto scenario =
      load("effects: {aberration: off}\n" + good + "    effects: {read_noise: off}\n");
  const auto& effects = scenario.sensors[0].effects;
  EXPECT_FALSE(effects.has(AnnualAberration::facts));
  EXPECT_FALSE(effects.has(DiurnalAberration::facts));
  EXPECT_FALSE(effects.has(ReadNoise::facts));
  EXPECT_TRUE(effects.has(AtmosphericRefraction::facts));
}

TEST_F(ScenarioFile, SwitchesDetectionForAllAndForOne) {
  EXPECT_TRUE(load(good).sensors[0].detect);
  EXPECT_FALSE(load("detection: off\n" + good).sensors[0].detect);
  EXPECT_TRUE(load("detection: off\n" + good + "    detection: on\n").sensors[0].detect);
}

}  // namespace
}  // namespace dmise
