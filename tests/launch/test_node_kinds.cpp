#include "core/config/node_kinds.h"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "core/config/make_clock.h"
#include "core/config/node_names.h"
#include "launch/run/node_makers.h"

namespace dmise {
namespace {

namespace fs = std::filesystem;

std::string text_of(const std::string& file) {
  std::ifstream in(DMISE_SOURCE_DIR "/launch/stack/" + file);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

struct SmallRun {
  SmallRun() {
    fs::create_directories(directory);
    std::ofstream(directory / "stars.csv") << "ra_deg,dec_deg,mag_v\n10,20,5\n";
    std::ofstream(directory / "small.yaml")
        << "simulation: {start: 2020-01-01T00:00:00Z, duration_s: 20, tick_s: 10}\n"
           "objects: [{name: ball, radius_m: 1, motion: {two_body: {semi_major_axis_m: 7e6, "
           "eccentricity: 0, inclination_deg: 90, raan_deg: 90}}}, {name: dart, motion: {node: "
           "gnc}}]\nnodes: [{name: gnc, run: [sh]}]\n"
           "stars: {catalogue: stars.csv}\noutput: {positions: [csv]}\nfusion: on\n"
           "sensors:\n  - {name: eye, site: {latitude_deg: 30, longitude_deg: 0, height_m: 0},\n"
           "     camera: {optics: {columns: 64, rows: 64, pixel_pitch_m: 1.0e-5, focal_length_m: "
           "0.1, aperture_m: 0.05}, detector: {full_well_e: 20000, gain_e_per_dn: 1}, band: "
           "{centre_m: 0.55e-6, width_m: 0.1e-6}},\n"
           "     pointing: {cued: on}, exposure_s: 5, cadence_s: 10}\n";
    scenario = load_scenario(directory / "small.yaml");
  }
  ~SmallRun() { fs::remove_all(directory); }

  fs::path directory = fs::path(testing::TempDir()) / "kinds";
  Scenario scenario;
};

TEST(NodeKinds, EveryKindIsMadeUnderItsNameAndPublishesItsTopics) {
  SmallRun run;
  ScenarioInputs scene = load_scene(run.scenario, make_clock(run.scenario));
  Threads threads(1);
  NodeParts parts{run.scenario, scene, "digest", run.directory, threads, [](const auto&) {}};
  for (const NodeKind& kind : node_kinds()) {
    const auto nodes = nodes_of(kind, run.scenario);
    ASSERT_EQ(nodes.size(), 1u) << kind.name;
    const auto node = maker_of(kind).make(nodes[0], parts);
    EXPECT_EQ(node->name(), nodes[0]);
    EXPECT_EQ(kind_of_node(nodes[0], run.scenario), &kind);
    std::set<std::string> topics;
    for (const auto& topic : kind.topics)
      topics.insert(topic.back() != '/'  ? topic
                    : kind.each_own_node ? topic + "gnc"
                                         : topic + "eye");
    const auto produced = node->produces();
    EXPECT_EQ(std::set<std::string>(produced.begin(), produced.end()), topics) << kind.name;
  }
}

TEST(NodeKinds, ASensorCannotBeCalledAsAKindIs) {
  for (const NodeKind& kind : node_kinds())
    if (!kind.each_sensor) {
      EXPECT_TRUE(NodeNames().fault_of(kind.name)) << kind.name;
    }
}

TEST(NodeKinds, WhatIsNotWantedIsNoNodeOfTheRun) {
  SmallRun run;
  EXPECT_EQ(nodes_of(run.scenario),
            (std::vector<std::string>{"orbit-node", "environment-node", "gnc", "eye",
                                      "positions-node", "fusion-node"}));
  run.scenario.output = {};
  run.scenario.fusion.reset();
  run.scenario.own_nodes.clear();
  EXPECT_EQ(nodes_of(run.scenario),
            (std::vector<std::string>{"orbit-node", "environment-node", "eye"}));
  EXPECT_TRUE(kind_of_node("positions-node", run.scenario));
  EXPECT_TRUE(kind_of_node("fusion-node", run.scenario));  // may stand by
  EXPECT_FALSE(kind_of_node("other", run.scenario));
}

// What a scenario does not want stands by.
TEST(NodeKinds, ComposeHasAServiceForEachKindAndNoOther) {
  std::set<std::string> services, expected{"time-master", "broker"};
  for (const auto& service : YAML::Load(text_of("compose.yaml"))["services"]) {
    const auto name = service.first.as<std::string>();
    services.insert(name);
    if (name == "time-master") continue;
    EXPECT_NE(service.second["command"].as<std::string>().find(".yaml} " + name + " --master"),
              std::string::npos)
        << name;
  }
  for (const NodeKind& kind : node_kinds()) expected.insert(kind.name);
  EXPECT_EQ(services, expected);
}

// A task for each, then those for each own node and each sensor.
TEST(NodeKinds, ASlurmJobHasATaskForEachKind) {
  const std::string job = text_of("slurm/run.sbatch");
  int task = 2;
  for (const NodeKind& kind : node_kinds()) {
    if (kind.each_sensor || kind.each_own_node) continue;
    const std::string line = std::to_string(task++) + ") node=" + kind.name + " ;;";
    EXPECT_NE(job.find(line), std::string::npos) << line;
  }
  EXPECT_NE(job.find("--ntasks=$((" + std::to_string(task) + " + SENSORS))"), std::string::npos);
  EXPECT_NE(job.find("--ntasks=$((" + std::to_string(task) + " + OWN_NODES + SENSORS))"),
            std::string::npos);
  EXPECT_NE(job.find("slot=$((SLURM_PROCID - " + std::to_string(task - 1) + "))"),
            std::string::npos);
}

}  // namespace
}  // namespace dmise
