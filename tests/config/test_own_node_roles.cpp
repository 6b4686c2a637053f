#include "core/config/own_node_roles.h"

#include <gmock/gmock.h>

#include "core/config/node_kinds.h"
#include "core/config/scenario.h"
#include "core/config/yaml/yaml_reader.h"
#include "tests/support/config_error.h"

namespace dmise {
namespace {

using test::config_error_of;
using testing::HasSubstr;

class NodesOfObjects : public testing::Test {
 protected:
  static Scenario load(const std::string& objects, const std::string& nodes,
                       const std::string& of_sensor = "") {
    return read_scenario(YamlValue::parse(
        "simulation: {start: 2018-01-21T00:15:00Z, duration_s: 30, tick_s: 5}\nobjects:\n" +
            objects + "nodes: " + nodes +
            "\nsensors:\n  - {name: eye, site: {latitude_deg: 30, longitude_deg: 0, height_m: 0}, "
            "camera: {optics: {columns: 64, rows: 64, pixel_pitch_m: 1.0e-5, focal_length_m: 0.1, "
            "aperture_m: 0.05}, detector: {full_well_e: 20000, gain_e_per_dn: 1}, band: "
            "{centre_m: 0.55e-6, width_m: 0.1e-6}}, pointing: zenith, exposure_s: 5, cadence_s: "
            "10" +
            of_sensor + "}\n",
        "s.yaml"));
  }
};

// What is in the file is read when it is started.
TEST_F(NodesOfObjects, AnFmuMovesOneObjectAndDoesNothingElse) {
  const std::string unit = "[{name: unit, fmu: " DMISE_SOURCE_DIR
                           "/README.md, outputs: {position_m: [x, y, z], "
                           "velocity_m_per_s: [u, v, w]}}]",
                    one = "  - {name: a, motion: {node: unit}, radius_m: 1}\n";
  const OwnNode node = load(one, unit).own_nodes.at(0);
  EXPECT_TRUE(node.is_fmu);
  EXPECT_THAT(node.run,
              testing::ElementsAre("python3", "-m", "dmise.fmi", testing::EndsWith(".md")));
  EXPECT_EQ(
      node.options_json,
      R"({"inputs":{},"outputs":{"position_m":["x","y","z"],"velocity_m_per_s":["u","v","w"]},)"
      R"("options":{}})");
  const std::string no_velocity = std::string(unit).replace(unit.find(", velocity"), 29, "");
  EXPECT_THAT(config_error_of([&] { load(one, no_velocity); }),
              HasSubstr("nodes[0].outputs: lacks velocity_m_per_s"));
  const std::string two = one + "  - {name: b, motion: {node: unit}, radius_m: 1}\n";
  EXPECT_THAT(config_error_of([&] { load(two, unit); }),
              HasSubstr("nodes[0]: an FMU moves or turns one object, got 2"));
  EXPECT_THAT(config_error_of([&] {
                load(
                    "  - {name: a, motion: {two_body: {semi_major_axis_m: 7e6, eccentricity: 0, "
                    "inclination_deg: 0, raan_deg: 0, true_anomaly_deg: 0}}, radius_m: 1}\n",
                    unit, ", detection: {node: unit}");
              }),
              HasSubstr("detection.node: an FMU moves or turns an object, and unit is one"));
}

TEST_F(NodesOfObjects, EachObjectHasItsPlaceAmongThoseOfItsNode) {
  const Scenario scenario = load(
      "  - {name: a, motion: {node: one}}\n"
      "  - {name: b, motion: {node: two}, attitude: {node: one}}\n"
      "  - {name: c, motion: {fixed: {gcrs_m: [7e6, 0, 0]}}, attitude: {node: two}}\n"
      "  - {name: d, motion: {node: one}, attitude: {node: one}}\n",
      "[{name: one, run: [sh]}, {name: two, run: [sh]}]");
  const auto& objects = scenario.own_objects;
  EXPECT_EQ(motion_by_node(objects[0])->place, 0u);
  EXPECT_EQ(motion_by_node(objects[1])->place, 0u);
  EXPECT_EQ(attitude_by_node(objects[1])->place, 1u);
  EXPECT_FALSE(motion_by_node(objects[2]));
  EXPECT_EQ(attitude_by_node(objects[2])->place, 1u);
  EXPECT_EQ(motion_by_node(objects[3])->place, 2u);
  EXPECT_EQ(attitude_by_node(objects[3])->place, 2u);
}

TEST_F(NodesOfObjects, NamesMustMatch) {
  const auto complaint = [](const std::string& objects, const std::string& nodes) {
    return config_error_of([&] { load(objects, nodes); });
  };
  EXPECT_THAT(complaint("  - {name: a, motion: {node: gnd}}\n", "[{name: gnc, run: [sh]}]"),
              HasSubstr("s.yaml:3:30: objects[0].motion.node: no node of `nodes` has this name, "
                        "did you mean gnc?, got gnd"));
  EXPECT_THAT(complaint("  - {name: a, motion: {node: gnc}}\n",
                        "[{name: gnc, run: [sh]}, {name: idle, run: [sh]}]"),
              HasSubstr("nodes[1]: moves and turns no object"));
  EXPECT_THAT(complaint("  - {name: a, motion: {node: eye}}\n", "[{name: eye, run: [sh]}]"),
              HasSubstr("nodes[0].name: another node has this name, got eye"));
  EXPECT_THAT(complaint("  - {name: a, motion: {node: broker}}\n", "[{name: broker, run: [sh]}]"),
              HasSubstr("another node has this name"));
}

TEST_F(NodesOfObjects, ANodeMayDetectInTheFramesOfASensor) {
  const std::string object = "  - {name: a, motion: {fixed: {gcrs_m: [7e6, 0, 0]}}}\n";
  const Scenario own = load(object, "[]");
  EXPECT_TRUE(own.sensors[0].detect);
  EXPECT_FALSE(own.sensors[0].detector);
  const Scenario scenario =
      load(object, "[{name: finder, run: [sh]}]", ", detection: {node: finder}");
  EXPECT_TRUE(scenario.sensors[0].detect);
  EXPECT_EQ(scenario.sensors[0].detector->node, "finder");
  EXPECT_EQ(scenario.own_nodes[0].role, OwnNodeRole::detector);
  EXPECT_NE(physics_json(scenario), physics_json(own));
  EXPECT_FALSE(load(object, "[]", ", detection: off").sensors[0].detect);
  // It runs in the sensor's process, and is no node of the run.
  EXPECT_FALSE(kind_of_node("finder", scenario));
  for (const std::string& node : nodes_of(scenario)) EXPECT_NE(node, "finder");
  EXPECT_TRUE(starts_program(*kind_of_node("eye", scenario), "eye", scenario));
  EXPECT_FALSE(starts_program(*kind_of_node("eye", own), "eye", own));
}

TEST_F(NodesOfObjects, ADetectorMustBeANodeThatDoesNothingElse) {
  const auto complaint = [](const std::string& motion, const std::string& node,
                            const std::string& detection) {
    return config_error_of([&] {
      load("  - {name: a, motion: {" + motion + "}}\n", "[{name: finder, " + node + "}]",
           ", detection: " + detection);
    });
  };
  const std::string fixed = "fixed: {gcrs_m: [7e6, 0, 0]}";
  EXPECT_THAT(complaint(fixed, "run: [sh]", "{node: findr}"),
              testing::AllOf(HasSubstr("sensors[0].detection.node: no node of `nodes` has this"),
                             HasSubstr("did you mean finder?, got findr")));
  EXPECT_THAT(complaint("node: finder", "run: [sh]", "{node: finder}"),
              HasSubstr("nodes[0]: moves or turns objects and detects"));
  EXPECT_THAT(complaint(fixed, "elsewhere: on", "{node: finder}"),
              HasSubstr("sensors[0].detection.node: its node is elsewhere"));
  EXPECT_THAT(complaint(fixed, "run: [sh], period_ticks: 2", "{node: finder}"),
              HasSubstr("nodes[0].period_ticks: a detector is asked for each frame: must be 1"));
  EXPECT_THAT(complaint(fixed, "run: [sh]", "on"), HasSubstr("no sensor detects by it"));
  EXPECT_THAT(complaint(fixed, "run: [sh]", "{}"), HasSubstr("no sensor detects by it"));
  EXPECT_THAT(complaint(fixed, "run: [sh]", "{nod: finder}"), HasSubstr("did you mean node?"));
  EXPECT_THAT(complaint(fixed, "run: [sh]", "perhaps"), HasSubstr("sensors[0].detection"));
}

class TrackingNode : public NodesOfObjects {
 protected:
  static Scenario track(const std::string& fusion, const std::string& node = "run: [sh]",
                        const std::string& motion = "fixed: {gcrs_m: [7e6, 0, 0]}") {
    return load("  - {name: a, motion: {" + motion + "}}\n",
                "[{name: mine, " + node + "}]\nfusion: " + fusion);
  }
  static std::string complaint(const std::string& fusion, const std::string& node = "run: [sh]",
                               const std::string& motion = "fixed: {gcrs_m: [7e6, 0, 0]}") {
    return config_error_of([&] { track(fusion, node, motion); });
  }
};

// It runs in the fusion node's process, and is no node of the run.
TEST_F(TrackingNode, MakesTheTracksInTheProcessOfTheFusionNode) {
  const Scenario scenario =
      track("{node: mine, cue_delay_ticks: 3, detection_probability: 0.5, not_in_catalogue: [X]}");
  EXPECT_EQ(scenario.fusion->node, "mine");
  EXPECT_EQ(scenario.own_nodes[0].role, OwnNodeRole::tracker);
  EXPECT_FALSE(kind_of_node("mine", scenario));
  EXPECT_TRUE(starts_program(*kind_of_node(fusion_node, scenario), fusion_node, scenario));
  const Scenario ours = load("  - {name: a, motion: {fixed: {gcrs_m: [7e6, 0, 0]}}}\n",
                             "[]\nfusion: {cue_delay_ticks: 3}");
  EXPECT_FALSE(starts_program(*kind_of_node(fusion_node, ours), fusion_node, ours));
  EXPECT_NE(physics_json(scenario), physics_json(ours));
}

TEST_F(TrackingNode, DoesNothingElseAndTakesNoKeysOfOurFilters) {
  EXPECT_THAT(complaint("{node: mime}"),
              testing::AllOf(HasSubstr("fusion.node: no node of `nodes` has this name"),
                             HasSubstr("did you mean mine?, got mime")));
  EXPECT_THAT(complaint("{node: mine}", "run: [sh]", "node: mine"),
              HasSubstr("nodes[0]: moves or turns objects and tracks: give each a node"));
  EXPECT_THAT(complaint("{node: mine}", "elsewhere: on"),
              HasSubstr("fusion.node: its node is elsewhere, but the fusion node starts its"));
  EXPECT_THAT(
      complaint("{node: mine}", "run: [sh], period_ticks: 2"),
      HasSubstr("nodes[0].period_ticks: a tracker is asked at each tick: must be 1, got 2"));
  EXPECT_THAT(complaint("on"), HasSubstr("it makes no tracks (fusion: {node: mine})"));
  for (const char* key : {"gate_d2", "lost_after_s", "pointing_sigma_arcsec", "arc_exposures"})
    EXPECT_THAT(complaint("{node: mine, " + std::string(key) + ": 20}"),
                HasSubstr("fusion." + std::string(key) +
                          ": is of the fusion node's own filters, and node mine makes the tracks, "
                          "got 20"));
  EXPECT_THAT(complaint("{node: mine, cue_delay_tick: 2}"),
              HasSubstr("did you mean cue_delay_ticks"));
}

class ObservingNode : public NodesOfObjects {
 protected:
  static Scenario observe(const std::string& sensor, const std::string& node = "run: [sh]",
                          const std::string& motion = "fixed: {gcrs_m: [7e6, 0, 0]}") {
    return load("  - {name: a, motion: {" + motion + "}}\n", "[{name: ranger, " + node + "}]",
                "}\n  - {name: radar, node: " + sensor);
  }
  static std::string complaint(const std::string& sensor, const std::string& node = "run: [sh]",
                               const std::string& motion = "fixed: {gcrs_m: [7e6, 0, 0]}") {
    return config_error_of([&] { observe(sensor, node, motion); });
  }
  static constexpr const char* times = ", exposure_s: 1, cadence_s: 5";
};

TEST_F(ObservingNode, IsASensorInTheProcessOfTheSensor) {
  const std::string site = "ranger, site: {latitude_deg: 30, longitude_deg: 10}";
  const Scenario scenario = observe(site + ", exposure_s: 1, cadence_s: 5, first_exposure_s: 2");
  const SensorConfig& radar = scenario.sensors.at(1);
  EXPECT_TRUE(scenario.sensors[0].is_camera());
  EXPECT_FALSE(radar.is_camera());
  EXPECT_EQ(radar.name, "radar");
  EXPECT_EQ(radar.started_node(), "ranger");
  EXPECT_EQ(site_of(radar)->latitude_deg, 30);
  EXPECT_EQ(radar.first_exposure_s, 2);
  EXPECT_FALSE(radar.observing->truth);
  EXPECT_EQ(radar.observing->half_angle_deg, 180);
  EXPECT_TRUE(radar.detect);
  EXPECT_EQ(scenario.own_nodes[0].role, OwnNodeRole::sensor);
  EXPECT_FALSE(kind_of_node("ranger", scenario));
  EXPECT_TRUE(starts_program(*kind_of_node("radar", scenario), "radar", scenario));
  EXPECT_THAT(nodes_of(scenario), testing::Contains("radar"));
}

// The orbit node publishes states for those who need them.
TEST_F(ObservingNode, NeedsStatesForItsTruthAndItsPlatform) {
  const std::string site =
      "ranger, site: {latitude_deg: 30, longitude_deg: 10}" + std::string(times);
  EXPECT_FALSE(observe(site).nodes_take_states());
  EXPECT_TRUE(observe(site + ", truth: on").nodes_take_states());
  EXPECT_TRUE(observe("ranger, platform: a" + std::string(times)).nodes_take_states());
  EXPECT_NE(physics_json(observe(site)), physics_json(observe(site + ", truth: on")));
  EXPECT_NE(physics_json(observe(site)), physics_json(observe(site + ", half_angle_deg: 3")));
}

TEST_F(ObservingNode, WhatIsWrongIsToldWithItsPlace) {
  const std::string at = ", platform: a" + std::string(times);
  EXPECT_THAT(complaint("rangr" + at),
              testing::AllOf(HasSubstr("sensors[1].node: no node of"),
                             HasSubstr("did you mean ranger?, got rangr")));
  EXPECT_THAT(complaint("ranger" + at, "run: [sh]", "node: ranger"),
              HasSubstr("nodes[0]: moves or turns objects and observes: give each a node"));
  EXPECT_THAT(complaint("ranger" + at, "elsewhere: on"),
              HasSubstr("sensors[1].node: its node is elsewhere, but a sensor starts its program"));
  EXPECT_THAT(complaint("ranger" + at, "run: [sh], period_ticks: 2"),
              HasSubstr("nodes[0].period_ticks: a sensor is asked at each exposure: must be 1"));
  EXPECT_THAT(complaint("ranger" + std::string(times)), HasSubstr("needs either site"));
  EXPECT_THAT(complaint("ranger" + at + ", camera: raven"),
              HasSubstr("sensors[1].camera: unknown"));
  EXPECT_THAT(complaint("ranger" + at + ", half_angle_deg: 0"),
              HasSubstr("half_angle_deg: must be"));
  EXPECT_THAT(complaint("ranger, platform: a, exposure_s: 9, cadence_s: 5"),
              HasSubstr("sensors[1].exposure_s: must be <= cadence_s, got 9"));
  EXPECT_THAT(complaint("ranger" + at + ", first_exposure_s: 30"),
              HasSubstr("the first exposure ends after the run does"));
}

TEST_F(ObservingNode, WhatNeedsACameraSaysSo) {
  Scenario scenario = observe("ranger, platform: a" + std::string(times));
  keep_cameras(scenario, "dmise survey");
  EXPECT_EQ(scenario.sensors.size(), 1u);
  scenario.sensors[0].observing.emplace();
  EXPECT_THAT(config_error_of([&] { keep_cameras(scenario, "dmise survey"); }),
              HasSubstr("sensors[0]: dmise survey needs a camera"));
}

TEST_F(NodesOfObjects, HearTopicsOfTheRun) {
  const std::string objects =
      "  - {name: a, motion: {node: one}}\n  - {name: b, motion: {node: two}}\n";
  const auto nodes = [](const std::string& consumes) {
    return "[{name: one, run: [sh], consumes: [" + consumes + "]}, {name: two, run: [sh]}]";
  };
  const Scenario scenario = load(objects, nodes("state/*, frame/eye, detection/*, frame/eye"));
  EXPECT_THAT(scenario.own_nodes.at(0).consumes,
              testing::ElementsAre("detection/eye", "frame/eye", "state/actor/two"));
  EXPECT_EQ(scenario.own_nodes[0].delay_ticks, 1);
  EXPECT_TRUE(scenario.own_nodes.at(1).consumes.empty());
  for (const std::string wrong :
       {"state/actor/one", "truth/eye", "track/*", "frame/ey", "frame*", "*"})
    EXPECT_THAT(config_error_of([&] { load(objects, nodes("frame/eye, \"" + wrong + "\"")); }),
                HasSubstr("nodes[0].consumes[1]: nobody publishes it"));
  EXPECT_THAT(config_error_of([&] {
                load(objects,
                     "[{name: one, run: [sh]}, {name: two, run: [sh]}, {name: finds, run: "
                     "[sh], consumes: [frame/eye]}]",
                     ", detection: {node: finds}");
              }),
              HasSubstr("nodes[2].consumes[0]: only a node that moves or turns objects consumes"));
}

}  // namespace
}  // namespace dmise
