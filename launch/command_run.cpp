#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <memory>

#include "core/base/error.h"
#include "core/sim/controller.h"
#include "launch/commands.h"
#include "core/config/make_clock.h"
#include "nodes/environment/environment_actor.h"
#include "sensors/pipeline/make_sensor.h"
#include "launch/prepare_run.h"
#include "launch/progress.h"
#include "launch/run_record.h"
#include "nodes/runtime/event.h"
#include "orbit-node/orbit_actor.h"

namespace dmise {
namespace {

struct RunOptions {
  std::string scenario, out;
  int threads = 1;
  bool force = false;
};

void run(const RunOptions& options) {
  const Scenario scenario = load_scenario(options.scenario);
  RunDirectory directory(options.out, scenario, scenario_digest(scenario));
  if (!prepare_directory(directory, options.force)) return;
  stop_signal();
  const auto start = std::chrono::steady_clock::now();
  RunOutcome outcome{.how = "one process"};
  Threads threads(options.threads);

  std::vector<SensorEvaluator*> sensors;
  int frames_total = 0;
  std::vector<std::unique_ptr<Participant>> participants;
  auto orbit = std::make_unique<OrbitActor>(scenario, make_clock(scenario), threads);
  for (const auto& note : orbit->notes()) std::fprintf(stderr, "note: %s\n", note.c_str());
  check_sensors(scenario, orbit->roster());
  participants.push_back(std::move(orbit));
  participants.push_back(std::make_unique<EnvironmentActor>(scenario, make_clock(scenario)));
  const auto stars = load_stars(scenario);
  for (const auto& sensor : scenario.sensors) {
    auto evaluator =
        make_sensor(scenario, sensor.name, directory.digest(), directory.path(), stars, threads);
    evaluator->stop_when([] { return stop_signal().is_set(); });
    frames_total += static_cast<int>(frames_within(sensor, scenario.duration));
    sensors.push_back(evaluator.get());
    participants.push_back(std::move(evaluator));
  }
  Progress progress;
  SimulationController controller(std::move(participants));
  const auto state_after = [&](Tick tick) {
    ProgressState state{.simulated_s = std::min(scenario.time_of(tick), scenario.duration).seconds(),
                        .duration_s = scenario.duration.seconds(),
                        .frames_total = frames_total};
    for (const auto* sensor : sensors) {
      state.frames += sensor->frames_done();
      state.detections += sensor->detections_made();
    }
    return state;
  };
  try {
    controller.run(scenario.last_tick(), [&](Tick tick) {
      const bool stop = stop_signal().is_set();
      progress.show(state_after(tick), stop || tick == scenario.last_tick());
      if (stop) outcome.status = "interrupted";
      return !stop;
    });
  } catch (const std::exception& e) {
    outcome.status = "failed";
    outcome.reason = e.what();
  }
  progress.clear_line();
  outcome.wall_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  finish_run(directory, scenario, outcome);
}

}  // namespace

void add_run_command(CLI::App& app) {
  auto options = std::make_shared<RunOptions>();
  auto* command = app.add_subcommand("run", "Runs a scenario in this process, without a network");
  command->add_option("scenario", options->scenario, "scenario (YAML)")->required();
  command->add_option("--out", options->out, "directory of the products")->default_val("out/run");
  command->add_option("--threads", options->threads, "threads to compute with; the products do not depend on it")
      ->default_val(1)
      ->check(CLI::Range(1, 256));
  command->add_flag("--force", options->force, "replace what is in the directory");
  command->callback([options] { run(*options); });
}

}  // namespace dmise
