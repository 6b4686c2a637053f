#include "sensors/frames/make_frames.h"

#include <memory>
#include <utility>

#include "core/base/error.h"
#include "core/config/make_clock.h"
#include "core/sim/controller.h"
#include "nodes/environment/environment_actor.h"
#include "nodes/own/own_actor.h"
#include "nodes/own/own_detector.h"
#include "orbit-node/orbit_actor.h"
#include "sensors/frame/make_sensor.h"
#include "sensors/frame/sensor_evaluator.h"

namespace dmise {
namespace {

std::unique_ptr<Participant> make_tapped(const Scenario& scenario, const FrameTap& tap,
                                         const std::string& digest,
                                         std::shared_ptr<const StarMap> stars, Threads& threads,
                                         const OwnNodeSettings& models) {
  const SensorConfig& sensor = sensor_named(scenario, tap.sensor);
  if (const auto* cued = std::get_if<PointCued>(&sensor.pointing))
    throw ConfigError(cued->where +
                      ": a run with all sensors tells it where to look: dmise run, dmise launch");
  PipelineSettings settings = sensor_settings(scenario, tap.sensor, digest);
  settings.output = {};
  settings.star_truth = false;
  OwnNodeSettings detector = models;
  detector.error_prefix = tap.sensor + ": ";
  settings.finder = own_finder(scenario, tap.sensor, "", std::move(detector));
  if (tap.set_up) tap.set_up(settings);
  auto evaluator =
      std::make_unique<SensorEvaluator>(settings, run_grid(scenario), std::move(stars), threads);
  evaluator->when_made(tap.made);
  return evaluator;
}

}  // namespace

void make_frames(Scenario scenario, ScenarioInputs scene, const std::string& digest,
                 const std::vector<FrameTap>& taps, Threads& threads,
                 const OwnNodeSettings& models) {
  scenario.network.publish_states = false;  // nobody outside this process can take them
  const Clock clock = make_clock(scenario);
  std::vector<std::unique_ptr<Participant>> participants;
  participants.push_back(
      std::make_unique<OrbitActor>(scenario, clock, std::move(scene.population), threads));
  participants.push_back(std::make_unique<EnvironmentActor>(scenario, clock));
  for (const OwnNode& node : scenario.own_nodes) {
    if (node.role != OwnNodeRole::actor) continue;
    OwnNodeSettings actor = models;
    actor.error_prefix = node.name + ": ";
    participants.push_back(std::make_unique<OwnActor>(scenario, node, clock, std::move(actor)));
  }
  for (const FrameTap& tap : taps)
    participants.push_back(make_tapped(scenario, tap, digest, scene.stars, threads, models));
  SimulationController(std::move(participants)).run(scenario.last_tick(), [](Tick) {
    return true;
  });
}

}  // namespace dmise
