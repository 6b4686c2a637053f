#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

#include "core/base/error.h"
#include "core/config/scenario.h"
#include "launch/commands.h"
#include "launch/file_lock.h"
#include "launch/run_directory.h"
#include "launch/supervisor.h"
#include "nodes/runtime/event.h"

namespace dmise {
namespace {

constexpr auto look_every = std::chrono::milliseconds(20);

struct JoinOptions {
  std::string scenario, node, out, master;
  std::vector<std::string> more;  // for the node's program
};

/// A node of a run whose time-master is elsewhere: `dmise launch --nodes-elsewhere`.
class Join {
 public:
  Join(const JoinOptions& options, const Scenario& scenario)
      : options_(options), scenario_(scenario), run_(run_lock_path(options.out)) {}

  /// The exit code: that of the node, once the run is over too, so that whoever watches the
  /// containers of a run sees the time-master's end and not a node's.
  int run() {
    wait_for_run();
    const auto place = take_place();
    if (!place) return 0;  // the run ended without need of another sensor
    std::filesystem::create_directories(options_.out + "/logs");
    const std::string log = options_.out + "/logs/" + name_ + ".log";
    processes_.start(name_, arguments(), log);
    watch();
    const int code = processes_.find(name_)->exit_code.value_or(1);
    if (code != 0) std::fprintf(stderr, "%s: %s\n", name_.c_str(), last_line(log).c_str());
    while (code_waits(code) && run_.held_elsewhere() && !stop_.is_set())
      std::this_thread::sleep_for(look_every);
    return stop_.is_set() ? 130 : code;
  }

 private:
  /// Where a failure is not the end of the run, somebody must be free to take this node's place.
  bool code_waits(int code) const {
    return code == 0 || scenario_.network.on_silent_node == OnSilentNode::fail;
  }

  void wait_for_run() {
    const auto deadline = std::chrono::steady_clock::now() +
                          std::chrono::duration<double>(scenario_.network.join_within_s);
    while (!run_.held_elsewhere()) {
      if (stop_.is_set()) throw ExitWith{130};
      if (std::chrono::steady_clock::now() > deadline)
        throw Error(options_.out + ": no run was started there in time");
      std::this_thread::sleep_for(look_every);
    }
  }

  /// The lock that makes this process the node of its name: the one asked for or, for `sensor`, the
  /// first sensor of the scenario that nobody is. One too many waits until one is missing.
  std::optional<FileLock> take_place() {
    std::vector<std::string> names;
    if (options_.node != "sensor")
      names = {options_.node};
    else
      for (const auto& sensor : scenario_.sensors) names.push_back(sensor.name);
    bool told = false;
    while (run_.held_elsewhere() && !stop_.is_set()) {
      for (const auto& name : names) {
        FileLock lock(options_.out + "/.nodes/" + name + ".lock");
        if (!lock.take()) continue;
        name_ = name;
        std::fprintf(stderr, "joining as %s\n", name.c_str());
        return lock;
      }
      if (!std::exchange(told, true))
        std::fprintf(stderr, "%s: taken; standing by\n", options_.node.c_str());
      std::this_thread::sleep_for(look_every);
    }
    return std::nullopt;
  }

  std::vector<std::string> arguments() const {
    const bool sensor = name_ != "broker" && name_ != "orbit-node" && name_ != "environment-node";
    std::vector<std::string> all{program_directory() + "/dmise-" + (sensor ? "sensor-node" : name_),
                                 "--name", name_, "--master", options_.master};
    if (name_ != "broker") all.insert(all.end(), {"--config", options_.scenario});
    if (sensor)
      all.insert(all.end(), {"--out", options_.out, "--digest", scenario_digest(scenario_),
                             "--seed", std::to_string(scenario_.seed)});
    all.insert(all.end(), options_.more.begin(), options_.more.end());
    return all;
  }

  /// Until the node has ended for good.
  void watch() {
    constexpr int killed = 128;  // codes above stand for signals
    while (!stop_.is_set()) {
      if (processes_.poll()) {
        std::this_thread::sleep_for(look_every);
        continue;
      }
      const Child& child = *processes_.find(name_);
      if (*child.exit_code <= killed || child.starts > scenario_.network.restarts ||
          scenario_.network.on_silent_node != OnSilentNode::restart)
        return;
      std::fprintf(stderr, "%s was killed and is started again\n", name_.c_str());
      processes_.restart(name_);
    }
    processes_.stop(std::chrono::milliseconds(1300));
  }

  const JoinOptions& options_;
  const Scenario& scenario_;
  FileLock run_;
  const Event& stop_ = stop_signal();
  Supervisor processes_;
  std::string name_;
};

void join(const JoinOptions& options) {
  const Scenario scenario = load_scenario(options.scenario);
  bool known = false;
  for (const char* name : {"broker", "orbit-node", "environment-node", "sensor"})
    known = known || options.node == name;
  for (const auto& sensor : scenario.sensors) known = known || options.node == sensor.name;
  if (!known) throw ConfigError(options.node + ": is no node of " + options.scenario);
  if (const int code = Join(options, scenario).run()) throw ExitWith{code};
}

}  // namespace

void add_join_command(CLI::App& app) {
  auto options = std::make_shared<JoinOptions>();
  auto* command = app.add_subcommand(
      "join", "Runs one node of a run started by `dmise launch --nodes-elsewhere`");
  command->add_option("scenario", options->scenario, "scenario (YAML), that of the run")
      ->required();
  command
      ->add_option("node", options->node,
                   "broker, orbit-node, environment-node, a sensor's name, or sensor: the first "
                   "that nobody is yet; one too many stands by")
      ->required();
  command->add_option("--out", options->out, "directory of the run, which all its nodes share")
      ->required();
  command->add_option("--master", options->master, "address of the time-master")->required();
  command->allow_extras();  // for the node's program: --threads, --log-level
  command->callback([options, command] {
    options->more = command->remaining();
    join(*options);
  });
}

}  // namespace dmise
