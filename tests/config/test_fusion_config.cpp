#include "core/config/fusion_config.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/files/json.h"
#include "core/config/scenario.h"
#include "core/config/yaml/yaml_reader.h"
#include "core/orbit/elements/epoch.h"
#include "core/time/iso8601.h"
#include "tests/support/data.h"

namespace dmise {
namespace {

FusionConfig read(const std::string& text) {
  YamlMap map(YamlValue::parse("fusion: " + text, "scenario.yaml"));
  return read_fusion(map.require("fusion"));
}

std::string complaint(const std::string& text) {
  try {
    read(text);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(FusionConfig, ReadsItsKeys) {
  const FusionConfig c = read(
      "{catalogue_sigma_m: [1, 2, 3], gate_d2: 25, detection_probability: 0.5, tentative_s: 30,\n"
      " confirm_unknown: 9, not_in_catalogue: [MYSTERY, 12345]}");
  EXPECT_EQ(c.settings.catalogue_sigma_m, (std::array<double, 3>{1, 2, 3}));
  EXPECT_EQ(c.settings.gate_d2, 25);
  EXPECT_EQ(c.settings.detection_probability, 0.5);
  EXPECT_EQ(c.settings.tentative_s, 30);
  EXPECT_EQ(c.settings.confirm_unknown, 9);
  EXPECT_EQ(c.settings.lost_after_s, FusionSettings().lost_after_s);
  EXPECT_EQ(c.not_in_catalogue, (std::vector<std::string>{"MYSTERY", "12345"}));
  EXPECT_EQ(read("on").settings.gate_d2, FusionSettings().gate_d2);
}

// Element sets of demo.tle are of the days before 2018-01-21.
TEST(FusionConfig, ReadsWhatTrackersBelieve) {
  const std::string file = test::catalogue_path("demo.tle");
  const FusionConfig c = read("{catalogue: \"" + file + "\", age_days: 3}");
  EXPECT_EQ(c.catalogue_path, file);
  EXPECT_EQ(c.age_days, 3);
  const Utc night = parse_utc("2018-01-21T00:00:00Z");
  for (const MeanElements& e : believed_elements(c, night))
    EXPECT_GE(epoch_days_between({e.epoch_jd1, e.epoch_jd2}, night), 3 - 1e-6);
  FusionConfig any = c;
  any.age_days.reset();
  EXPECT_GT(believed_elements(any, night).size(), believed_elements(c, night).size());
  FusionConfig old = c;
  old.age_days = 9000;
  EXPECT_THROW(believed_elements(old, night), ConfigError);
  EXPECT_NE(complaint("{age_days: 3}").find("fusion.age_days: goes with catalogue"),
            std::string::npos)
      << complaint("{age_days: 3}");
  EXPECT_NE(complaint("{catalogue: nowhere.tle}").find("fusion.catalogue"), std::string::npos);
}

TEST(FusionConfig, NamesTheKeyOfWhatIsWrong) {
  EXPECT_NE(complaint("{gate_d2: 0}").find("scenario.yaml:1:19: fusion.gate_d2: "),
            std::string::npos)
      << complaint("{gate_d2: 0}");
  EXPECT_NE(complaint("{catalogue_sigma_m: [1, 2]}").find("catalogue_sigma_m"), std::string::npos);
  EXPECT_NE(complaint("{catalogue_sigma_m: [0, 2, 3]}").find("catalogue_sigma_m"),
            std::string::npos);
  EXPECT_NE(complaint("{detection_probability: 1}").find("detection_probability"),
            std::string::npos);
  EXPECT_NE(complaint("{gate_d: 20}").find("did you mean gate_d2"), std::string::npos)
      << complaint("{gate_d: 20}");
}

std::string scenario_text(const std::string& cued, const std::string& more = "fusion: on\n",
                          const std::string& place = "site: {latitude_deg: 32, longitude_deg: 0}",
                          const std::string& of_sensor = "", const std::string& detector = "") {
  return "simulation: {start: 2018-01-20T00:00:00Z, duration_s: 100, tick_s: 10}\n" + more +
         "sensors:\n  - {name: eye, " + place +
         ", camera: {optics: {columns: 100, rows: 100, pixel_pitch_m: 1.0e-5, focal_length_m: 1, "
         "aperture_m: 0.4}, detector: {full_well_e: 20000, gain_e_per_dn: 1" +
         detector + "}, band: {centre_m: 0.55e-6, width_m: 0.1e-6}}, pointing: " + cued +
         ", exposure_s: 1, cadence_s: 10" + of_sensor + "}\n";
}

Scenario scenario_of(const std::string& text) {
  return read_scenario(YamlValue::parse(text, "scenario.yaml"));
}

std::string refusal(const std::string& text) {
  try {
    scenario_of(text);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(CuedPointing, ReadsItsKeys) {
  const Scenario scenario = scenario_of(
      scenario_text("{cued: {park: {azimuth_deg: 90, elevation_deg: 45}, slew_deg_per_s: 3, "
                    "slew_deg_per_s2: 1.5, settle_s: 4, least_elevation_deg: 25, "
                    "sun_exclusion_deg: 40, moon_exclusion_deg: 10, exposures: 5, sigma_arcsec: 2, "
                    "limiting_magnitude: 12.5, least_gain_nats: 0.5}, tracking: sidereal}",
                    "fusion: {cue_delay_ticks: 3}\n"));
  const auto& cued = std::get<PointCued>(scenario.sensors[0].pointing);
  EXPECT_EQ(cued.park.azimuth_deg, 90);
  EXPECT_EQ(cued.park.elevation_deg, 45);
  EXPECT_EQ(cued.cue.slew_deg_per_s, 3);
  EXPECT_EQ(cued.cue.slew_deg_per_s2, 1.5);
  EXPECT_EQ(cued.cue.settle_s, 4);
  EXPECT_EQ(cued.cue.min_elevation_deg, 25);
  EXPECT_EQ(cued.cue.sun_exclusion_deg, 40);
  EXPECT_EQ(cued.cue.moon_exclusion_deg, 10);
  EXPECT_EQ(cued.cue.exposures, 5);
  EXPECT_EQ(cued.cue.sigma_arcsec, 2);
  EXPECT_EQ(cued.cue.limiting_magnitude, 12.5);
  EXPECT_EQ(cued.cue.min_gain_nats, 0.5);
  EXPECT_EQ(scenario.fusion->cue_delay_ticks, 3);
  EXPECT_EQ(scenario.sensors[0].tracking, Tracking::sidereal);
  EXPECT_EQ(scenario_of(scenario_text("{cued: on}")).sensors[0].tracking, Tracking::target);
  // Whatever changes the products is in the text that they are told by.
  const std::string usual = physics_json(scenario_of(scenario_text("{cued: on}")));
  for (const char* key :
       {"slew_deg_per_s", "slew_deg_per_s2", "settle_s", "least_elevation_deg", "sun_exclusion_deg",
        "moon_exclusion_deg", "sigma_arcsec", "limiting_magnitude", "least_gain_nats"})
    EXPECT_NE(physics_json(scenario_of(scenario_text("{cued: {" + std::string(key) + ": 7.5}}"))),
              usual)
        << key;
}

TEST(CuedPointing, ThatIsOffIsNone) {
  for (const char* off : {"off", "no", "false"}) {
    const auto pointing = [&](const std::string& more) {
      return scenario_of(scenario_text("{cued: " + std::string(off) + more + "}"))
          .sensors[0]
          .pointing;
    };
    EXPECT_TRUE(std::holds_alternative<PointUp>(pointing("")));
    EXPECT_TRUE(
        std::holds_alternative<PointHorizon>(pointing(", azimuth_deg: 1, elevation_deg: 2")));
  }
  EXPECT_NE(refusal(scenario_text("{cued: 5}"))
                .find("pointing.cued: must be on, off or a mapping, got 5"),
            std::string::npos);
}

TEST(CuedPointing, ItsAzimuthIsAsFastAsItsElevationUnlessSaid) {
  const auto cue_of = [](const std::string& keys) {
    const Scenario scenario =
        scenario_of(scenario_text("{cued: {mount: altazimuth, " + keys + "}}"));
    return std::get<PointCued>(scenario.sensors[0].pointing).cue;
  };
  const CueSettings same = cue_of("slew_deg_per_s: 3, slew_deg_per_s2: 2");
  EXPECT_EQ(same.azimuth_deg_per_s, 3);
  EXPECT_EQ(same.azimuth_deg_per_s2, 2);
  const CueSettings slower = cue_of("slew_deg_per_s: 3, slew_deg_per_s2: 2, azimuth_deg_per_s2: 1");
  EXPECT_EQ(slower.azimuth_deg_per_s, 3);
  EXPECT_EQ(slower.azimuth_deg_per_s2, 1);
}

TEST(CuedPointing, ReadsTheAxesOfItsMount) {
  const auto cue_of = [](const std::string& keys) {
    const Scenario scenario = scenario_of(scenario_text("{cued: {" + keys + "}}"));
    return std::get<PointCued>(scenario.sensors[0].pointing).cue;
  };
  const CueSettings cue = cue_of(
      "mount: altazimuth, azimuth_deg_per_s: 8, azimuth_deg_per_s2: 4, azimuth_range_deg: "
      "[-200, 300], greatest_elevation_deg: 85");
  EXPECT_EQ(cue.mount, MountKind::altazimuth);
  EXPECT_EQ(cue.azimuth_deg_per_s, 8);
  EXPECT_EQ(cue.azimuth_deg_per_s2, 4);
  EXPECT_EQ(cue.azimuth_range_deg[0], -200);
  EXPECT_EQ(cue.azimuth_range_deg[1], 300);
  EXPECT_EQ(cue.greatest_elevation_deg, 85);
  EXPECT_EQ(cue_of("settle_s: 1").mount, MountKind::great_circle);
  const auto physics = [](const std::string& keys) {
    return physics_json(scenario_of(scenario_text("{cued: {" + keys + "}}")));
  };
  const std::string usual = physics("mount: altazimuth");
  EXPECT_EQ(physics("mount: great_circle"), physics("settle_s: 2"));
  EXPECT_NE(physics("settle_s: 2"), usual);
  for (const char* key : {"azimuth_deg_per_s: 7", "azimuth_deg_per_s2: 7",
                          "azimuth_range_deg: [-7, 7]", "greatest_elevation_deg: 77"})
    EXPECT_NE(physics("mount: altazimuth, " + std::string(key)), usual) << key;
}

TEST(CuedPointing, NamesWhatIsWrong) {
  const auto refused = [](const std::string& text, const std::string& why) {
    const std::string line = refusal(text);
    EXPECT_NE(line.find(why), std::string::npos) << why << " in: " << line;
  };
  refused(scenario_text("{cued: {slew_deg_per_s: 0}}"),
          "pointing.cued.slew_deg_per_s: must be > 0");
  refused(scenario_text("{cued: {exposures: 0}}"), "pointing.cued.exposures: ");
  refused(scenario_text("{cued: {park: {elevation_deg: 5}}}"), "pointing.cued.park.azimuth_deg: ");
  refused(scenario_text("{cued: {slew_deg_per_ss: 5}}"), "did you mean slew_deg_per_s");
  refused(scenario_text("{cued: {mount: altazimut}}"), "must be one of great_circle, altazimuth");
  refused(scenario_text("{cued: {azimuth_deg_per_s: 5}}"), "set mount: altazimuth");
  refused(scenario_text("{cued: {mount: altazimuth, azimuth_range_deg: [5, 5]}}"), "must rise");
  refused(scenario_text("{cued: {least_elevation_deg: 50, greatest_elevation_deg: 40}}"),
          "greatest_elevation_deg: must be >= 50");
  refused(scenario_text("{cued: on}", "fusion: {arc_exposures: 3}\n"),
          "fusion.arc_exposures: must be 0 (one site begins no track) or >= 4, got 3");
  refused(scenario_text("{cued: on, target: X}"), "give one of azimuth_deg");
  refused(scenario_text("{cued: on, tracking: fixed}"), "follows its target or the stars");
  refused(scenario_text("{cued: on}", ""), "sensors[0].pointing.cued: needs fusion");
  refused(scenario_text("{cued: on}", "fusion: {cue_delay_ticks: 0}\n"), "fusion.cue_delay_ticks");
  refused(scenario_text("{cued: on}", "fusion: on\n", "platform: X"), "for a sensor on the ground");
  refused(scenario_text("{cued: on}", "fusion: on\n", "site: {latitude_deg: 32, longitude_deg: 0}",
                        "", ", persistence_fraction: 0.01, persistence_s: 100"),
          "persistence needs all exposures");
}

}  // namespace
}  // namespace dmise
