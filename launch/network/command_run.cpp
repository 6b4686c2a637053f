#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/files/paths.h"
#include "core/config/make_clock.h"
#include "core/config/node_kinds.h"
#include "core/run/run_files.h"
#include "core/sim/controller.h"
#include "core/sim/participant.h"
#include "launch/command/command.h"
#include "launch/command/common_options.h"
#include "launch/command/notes.h"
#include "launch/run/node_makers.h"
#include "launch/run/prepare_run.h"
#include "launch/run/progress.h"
#include "launch/run/replayed_nodes.h"
#include "launch/run/run_outcome.h"
#include "launch/run/scenario_forecast.h"
#include "nodes/runtime/process/event.h"
#include "sensors/frame/recorded_plans.h"
#include "sensors/frame/sensor_evaluator.h"

namespace dmise {
namespace {

struct RunOptions {
  std::string scenario, out, plan;
  std::optional<std::uint64_t> seed;  // instead of the scenario's
  int threads = 1;
  bool force = false, allow_programs = false;
  std::vector<std::string> replayed;  // NODE=FILE
};

constexpr auto patience_after_stop = std::chrono::milliseconds(1500);

/// A run of a scenario in this process. Steps are performed by a separate thread, so that a stop
/// request is handled promptly, also in the middle of a frame.
class EmbeddedRun {
 public:
  EmbeddedRun(const Scenario& scenario, ScenarioInputs scene, const RunDirectory& directory,
              int thread_count, Tick first_tick, ReplayedNodes replayed)
      : scenario_(scenario), threads_(thread_count), first_tick_(first_tick) {
    print_forecast(scenario, scene, make_clock(scenario));
    NodeParts parts{scenario,           scene,    directory.digest(),
                    directory.path(),   threads_, [this](const std::string& line) { note(line); },
                    std::move(replayed)};
    for (const NodeKind& kind : node_kinds())
      for (const auto& node : nodes_of(kind, scenario)) {
        participants_.push_back(maker_of(kind).make(node, parts));
        if (auto* sensor = dynamic_cast<SensorEvaluator*>(participants_.back().get())) {
          sensor->stop_when([] { return stop_signal().is_set(); });
          sensors_.push_back(sensor);
        }
      }
    found_ = state_after(std::max<Tick>(0, first_tick_ - 1));
    for (const auto& sensor : scenario.sensors) {
      frames_total_ += static_cast<int>(frames_within(sensor, scenario.duration));
      const std::string lines = directory.path() + "/" + sensor.name;
      found_.frames += int(count_lines(path_in(lines, run_file::frames)));
      found_.detections += count_lines(path_in(lines, run_file::detections));
    }
    found_.frames_total = frames_total_;
  }

  /// Returns when all ticks are done, one failed, or a stop was requested. In the last case the
  /// current step may continue in its thread for a while: `in_step()`.
  RunOutcome run() {
    RunOutcome outcome{.how = "one process"};
    state_ = found_;
    Progress progress;
    std::thread worker([this] { make_ticks(); });
    std::unique_lock lock(mutex_);
    while (!finished_ && !stop_signal().is_set()) {
      changed_.wait_for(lock, std::chrono::milliseconds(50));
      for (const auto& line : std::exchange(notes_, {})) {
        progress.clear_line();
        print_note(line);
      }
      progress.show(state_, finished_);
    }
    if (!finished_) changed_.wait_for(lock, patience_after_stop, [this] { return finished_; });
    progress.clear_line();
    for (const auto& line : std::exchange(notes_, {})) print_note(line);
    if (stop_signal().is_set() && failure_.empty()) outcome.status = "interrupted";
    if (!failure_.empty()) {
      outcome.status = "failed";
      outcome.reason = failure_;
    }
    const bool finished = finished_;
    lock.unlock();
    finished ? worker.join() : worker.detach();
    return outcome;
  }
  bool in_step() {
    std::lock_guard lock(mutex_);
    return !finished_;
  }

 private:
  void note(const std::string& line) {
    std::lock_guard lock(mutex_);
    notes_.push_back(line);
  }

  void make_ticks() {
    std::string failure;
    try {
      SimulationController controller(std::move(participants_));
      controller.run(
          scenario_.last_tick(),
          [this](Tick tick) {
            std::lock_guard lock(mutex_);
            state_ = state_after(tick);
            changed_.notify_one();
            return !stop_signal().is_set();
          },
          first_tick_);
      for (const auto* sensor : sensors_) {
        if (const std::string evaluator = sensor->evaluator(); !evaluator.empty())
          note(sensor->name() + ": drawn by " + evaluator);
        if (const std::string renderer = sensor->renderer(); !renderer.empty())
          note(sensor->name() + ": shapes drawn by " + renderer);
      }
    } catch (const std::exception& e) {
      failure = e.what();
    }
    std::lock_guard lock(mutex_);
    failure_ = failure;
    finished_ = true;
    changed_.notify_one();
  }

  ProgressState state_after(Tick tick) const {
    ProgressState state{
        .simulated_s = std::min(scenario_.time_of(tick), scenario_.duration).seconds(),
        .duration_s = scenario_.duration.seconds(),
        .frames_total = frames_total_};
    for (const auto* sensor : sensors_) {
      state.frames += sensor->frames_done();
      state.detections += sensor->detections_made();
    }
    return state;
  }

  const Scenario& scenario_;
  Threads threads_;
  Tick first_tick_;
  std::vector<std::unique_ptr<Participant>> participants_;
  std::vector<SensorEvaluator*> sensors_;
  int frames_total_ = 0;
  ProgressState found_;  // before the first step: products of an earlier run
  std::mutex mutex_;     // guards what follows
  std::condition_variable changed_;
  ProgressState state_;
  std::vector<std::string> notes_;  // to be printed: lost objects, renderers
  std::string failure_;
  bool finished_ = false;
};

/// The nodes whose programs take part.
std::vector<OwnNode> nodes_without(const std::map<std::string, std::string>& recordings,
                                   const Scenario& scenario) {
  std::vector<OwnNode> nodes = scenario.own_nodes;
  std::erase_if(nodes, [&](const OwnNode& node) { return recordings.contains(node.name); });
  return nodes;
}

/// Nobody can join a run in one process.
void refuse_elsewhere(const std::vector<OwnNode>& nodes) {
  for (const OwnNode& node : nodes)
    if (node.run.empty())
      throw ConfigError(node.where + ": is elsewhere: only `dmise launch` lets it join");
}

void run(const RunOptions& options) {
  Scenario scenario = load_scenario(options.scenario);
  const auto recordings = recordings_of(options.replayed, scenario);
  const std::vector<OwnNode> programs = nodes_without(recordings, scenario);
  if (!options.allow_programs) refuse_programs(programs);
  refuse_elsewhere(programs);
  if (options.seed) scenario.seed = *options.seed;
  if (!options.plan.empty()) replay_plans(options.plan, scenario);
  scenario.network.publish_states = false;  // nobody outside this process can take them
  ScenarioInputs scene = load_scene(scenario, make_clock(scenario));
  RunDirectory directory(options.out, scenario, scenario_digest(scenario));
  ReplayedNodes replayed = replayed_nodes(recordings, scenario, directory.digest());
  const RunStart begin = prepare_directory(directory, scenario, options.force);
  if (!begin.needed) return;
  stop_signal();
  if (!scenario.own_nodes.empty()) make_directories(directory.path() + "/logs");
  const auto start = std::chrono::steady_clock::now();
  EmbeddedRun embedded(scenario, std::move(scene), directory, options.threads, begin.first_tick,
                       std::move(replayed));
  RunOutcome outcome = embedded.run();
  outcome.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!embedded.in_step()) return finish_run(directory, scenario, outcome);
  try {
    finish_run(directory, scenario, outcome);
  } catch (const ExitWith&) {
  }
  // The current step still uses objects of this scope: exit without destroying them.
  std::fflush(nullptr);
  std::_Exit(exit_code(outcome.status));
}

void add_run_options(CLI::App& command) {
  auto options = std::make_shared<RunOptions>();
  command.add_option("scenario", options->scenario, "scenario (YAML)")->required();
  command.add_option("--out", options->out, "directory of the products")->default_val("out/run");
  add_threads_option(command, options->threads,
                     "number of threads; the products do not depend on it");
  add_seed_option(command, options->seed, "seed of the random numbers, instead of the scenario's");
  command.add_option("--plan", options->plan,
                     "run.json of a run: its frames' levels of effects instead of a plan");
  add_allow_programs_flag(command, options->allow_programs);
  command
      .add_option("--replay-node", options->replayed,
                  "NODE=FILE: what the node has said in a recorded run (MCAP), in place of its "
                  "program; for several nodes give it several times")
      ->allow_extra_args(false);
  command.add_flag("--force", options->force, "replace the products in the directory");
  command.callback([options] { run(*options); });
}

}  // namespace

Command run_command() {
  return {.group = CommandGroup::scenarios,
          .summary = "Runs a scenario in this process, without a network",
          .add_options = add_run_options};
}

}  // namespace dmise
