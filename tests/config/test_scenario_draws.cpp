#include "core/config/scenario_draws.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>

#include "core/base/error.h"

namespace dmise {
namespace {

const std::string good =
    R"(simulation:
  start: {uniform: [2018-01-21T00:00:00Z, 2018-01-21T10:00:00Z]}
  duration_s: 60
  tick_s: 5
sensors:
  - name: atlanta
    site: {latitude_deg: {uniform: [30, 34]}, longitude_deg: -84.398, height_m: 300}
    camera: {one_of: [omnissa, raven]}
    pointing: {azimuth_deg: {uniform: [0, 360]}, elevation_deg: 60}
    exposure_s: &exposure {log_uniform: [1, 20]}
    cadence_s: 30
    first_exposure_s: *exposure
)";

class ScenarioDrawsTest : public testing::Test {
 protected:
  std::string path = (std::filesystem::path(testing::TempDir()) / "draws.yaml").string();
  void SetUp() override { setenv("DMISE_HOME", DMISE_SOURCE_DIR, 1); }
  void TearDown() override { std::remove(path.c_str()); }

  ScenarioDraws draws(std::string text = good, const std::string& what = "",
                      const std::string& with = "") {
    if (!what.empty()) text.replace(text.find(what), what.size(), with);
    std::ofstream(path) << text;
    return ScenarioDraws(path);
  }
  template <class Work>
  std::string complaint(const Work& work) {
    try {
      work();
    } catch (const ConfigError& e) {
      std::string message = e.what();
      return message.starts_with(path) ? message.substr(path.size() + 1) : message;
    }
    return "";
  }
};

TEST_F(ScenarioDrawsTest, TheScenarioHasWhatWasDrawn) {
  const DrawnScenario sample = draws().draw(12);
  EXPECT_EQ(sample.scenario.seed, 12u);
  std::map<std::string, std::string> drawn;
  for (const auto& value : sample.drawn) drawn[value.path] = value.text;
  ASSERT_EQ(drawn.size(), 5u);
  const SensorConfig& sensor = sample.scenario.sensors[0];
  EXPECT_EQ(sample.scenario.start_utc, drawn["simulation.start"]);
  EXPECT_EQ(sensor.camera.name, drawn["sensors[0].camera"]);
  EXPECT_EQ(sensor.exposure_s, std::stod(drawn["sensors[0].exposure_s"]));
  EXPECT_EQ(std::get<SiteConfig>(sensor.place).latitude_deg,
            std::stod(drawn["sensors[0].site.latitude_deg"]));
}

TEST_F(ScenarioDrawsTest, AnAliasIsTheSameDraw) {
  for (std::uint64_t seed = 1; seed < 9; ++seed) {
    const SensorConfig sensor = draws().draw(seed).scenario.sensors[0];
    EXPECT_EQ(sensor.exposure_s, sensor.first_exposure_s);
  }
}

TEST_F(ScenarioDrawsTest, ADrawDoesNotDependOnOtherDraws) {
  const SensorConfig one = draws().draw(3).scenario.sensors[0];
  const SensorConfig other =
      draws(good, "{latitude_deg: {uniform: [30, 34]},", "{latitude_deg: 31,")
          .draw(3)
          .scenario.sensors[0];
  EXPECT_EQ(one.exposure_s, other.exposure_s);
  EXPECT_EQ(one.camera.name, other.camera.name);
}

TEST_F(ScenarioDrawsTest, AChoiceMayBeAMappingWithDrawsOfItsOwn) {
  const auto choices = draws(good, "{azimuth_deg: {uniform: [0, 360]}, elevation_deg: 60}",
                             "{one_of: [{ra_deg: {uniform: [0, 9]}, dec_deg: 5}, zenith]}");
  int sky = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const DrawnScenario sample = choices.draw(seed);
    const auto* at = std::get_if<PointSky>(&sample.scenario.sensors[0].pointing);
    sky += at != nullptr;
    if (at) {
      EXPECT_LE(at->ra_deg, 9.0);
    }
  }
  EXPECT_GT(sky, 5);
  EXPECT_LT(sky, 35);
}

TEST_F(ScenarioDrawsTest, AChoiceMayBeAChoice) {
  const auto choices =
      draws(good, "{log_uniform: [1, 20]}", "{one_of: [3, {one_of: [4, {one_of: [5, 6]}]}]}");
  EXPECT_EQ(complaint([&] { choices.check_ends(); }), "");
  std::set<double> taken;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const DrawnScenario sample = choices.draw(seed);
    const SensorConfig& sensor = sample.scenario.sensors[0];
    taken.insert(sensor.exposure_s);
    EXPECT_EQ(sensor.exposure_s, sensor.first_exposure_s);
    for (const DrawnValue& value : sample.drawn)
      if (value.path == "sensors[0].exposure_s") {
        EXPECT_EQ(std::stod(value.text), sensor.exposure_s);
      }
  }
  EXPECT_EQ(taken, (std::set<double>{3, 4, 5, 6}));
}

TEST_F(ScenarioDrawsTest, EachOfNestedChoicesIsNamed) {
  const auto choices =
      draws(good, "{azimuth_deg: {uniform: [0, 360]}, elevation_deg: 60}",
            "{one_of: [{one_of: [{ra_deg: 1, dec_deg: 5}, {ra_deg: 2, dec_deg: 5}]}]}");
  EXPECT_EQ(complaint([&] { choices.check_ends(); }), "");
  const DrawnScenario sample = choices.draw(1);
  std::map<std::string, std::string> drawn;
  for (const auto& value : sample.drawn) EXPECT_TRUE(drawn.emplace(value.path, value.text).second);
  EXPECT_EQ(drawn["sensors[0].pointing.one_of"], "0");
  EXPECT_EQ(std::stod(drawn["sensors[0].pointing.one_of/1"]) + 1,
            std::get<PointSky>(sample.scenario.sensors[0].pointing).ra_deg);
}

TEST_F(ScenarioDrawsTest, PresetsHoldNone) {
  const std::string preset = path + ".camera.yaml";
  std::ofstream(preset) << "detector: {bias_dn: {integers: [1, 9]}}\n";
  for (const std::string latitude : {"{uniform: [30, 34]}", "31"}) {
    std::string text = good;
    text.replace(text.find("{one_of: [omnissa, raven]}"), 26, preset);
    const std::string message =
        complaint([&] { draws(text, "{uniform: [30, 34]}", latitude).check_ends(); });
    EXPECT_NE(message.find("camera.yaml:1:21: detector.bias_dn: is a distribution (integers): "
                           "presets hold none, only the scenario itself does"),
              std::string::npos)
        << message;
  }
  std::remove(preset.c_str());
}

TEST_F(ScenarioDrawsTest, ARunRefusesDistributions) {
  draws();
  EXPECT_EQ(complaint([&] { load_scenario(path); }),
            "2:10: simulation.start: is a distribution (uniform): dmise dataset draws a value for "
            "each seed");
}

TEST_F(ScenarioDrawsTest, EndsThatNoSensorTakesAreNamed) {
  EXPECT_EQ(complaint([&] { draws().check_ends(); }), "");
  const auto of = [&](const char* what, const char* with) {
    return complaint([&] { draws(good, what, with).check_ends(); });
  };
  EXPECT_EQ(of("{uniform: [30, 34]}", "{uniform: [30, 91]}"),
            "7:26: sensors[0].site.latitude_deg: must be <= 90, got 91 (the most of its uniform)");
  EXPECT_NE(
      of("[omnissa, raven]", "[omnissa, ravn]").find("camera: no such camera, did you mean raven?"),
      std::string::npos);
  EXPECT_NE(of("[omnissa, raven]", "[omnissa, ravn]").find("(choice 2 of its one_of)"),
            std::string::npos);
  for (const auto& [wrong, meant] :
       {std::pair("{unifrom: [1, 20]}", "unifrom: unknown key, did you mean uniform?"),
        std::pair("{one_fo: [1, 2]}", "one_fo: unknown key, did you mean one_of?"),
        std::pair("{norml: {mean: 5, sigma: 1}}", "norml: unknown key, did you mean normal?")})
    EXPECT_NE(of("{log_uniform: [1, 20]}", wrong).find(meant), std::string::npos) << wrong;
  EXPECT_NE(of("{log_uniform: [1, 20]}", "{normal: {mean: 5, sigma: 1}}")
                .find("(5 sigma from the mean of its normal, which has no min)"),
            std::string::npos);
  EXPECT_NE(of("elevation_deg: 60", "elevation_deg: {one_of: [60, {uniform: [0, 95]}]}")
                .find("must be <= 90, got 95 (the most of its uniform)"),
            std::string::npos);
}

TEST_F(ScenarioDrawsTest, EveryChoiceIsVisited) {
  std::multiset<std::string> cameras;
  draws(good, "[omnissa, raven]", "[omnissa, {one_of: [raven, star-tracker]}]")
      .check_ends(
          [&](const Scenario& scenario) { cameras.insert(scenario.sensors[0].camera.name); });
  EXPECT_GE(cameras.count("omnissa"), 1u);
  EXPECT_GE(cameras.count("raven"), 1u);
  EXPECT_EQ(cameras.count("star-tracker"), 1u);
}

// A name may have digits alone; a number of the same digits is one.
TEST_F(ScenarioDrawsTest, AChoiceIsANumberWhereItsKeyTakesOne) {
  const auto is_number = [&](const char* what, const char* with, const char* path) {
    for (const auto& value : draws(good, what, with).draw(1).drawn)
      if (value.path == path) return value.is_number;
    ADD_FAILURE() << path;
    return false;
  };
  EXPECT_FALSE(is_number("name: atlanta", "name: {one_of: [007, 1e3]}", "sensors[0].name"));
  EXPECT_TRUE(
      is_number("cadence_s: 30", "cadence_s: {one_of: [4e1, +30]}", "sensors[0].cadence_s"));
  EXPECT_TRUE(
      is_number("tick_s: 5", "tick_s: {one_of: [5, {one_of: [5, 5]}]}", "simulation.tick_s"));
  EXPECT_FALSE(is_number("{azimuth_deg: {uniform: [0, 360]}, elevation_deg: 60}",
                         "{target: {one_of: [29155, 36411]}}", "sensors[0].pointing.target"));
  EXPECT_TRUE(is_number("elevation_deg: 60", "elevation_deg: {uniform: [50, 60]}",
                        "sensors[0].pointing.elevation_deg"));
  EXPECT_TRUE(is_number("{azimuth_deg: {uniform: [0, 360]}, elevation_deg: 60}",
                        "{one_of: [{azimuth_deg: 5, elevation_deg: {one_of: [50, 60]}}]}",
                        "sensors[0].pointing.elevation_deg"));
}

TEST_F(ScenarioDrawsTest, AFaultOfTogetherDrawnValuesNamesTheSeed) {
  const auto both = draws(good, "cadence_s: 30", "cadence_s: {uniform: [5, 30]}");
  const std::string message = complaint([&] {
    for (std::uint64_t seed = 1; seed < 1000; ++seed) both.draw(seed);
  });
  EXPECT_NE(message.find("must be <= cadence_s"), std::string::npos) << message;
  EXPECT_NE(message.find("(as drawn for seed "), std::string::npos) << message;
}

}  // namespace
}  // namespace dmise
