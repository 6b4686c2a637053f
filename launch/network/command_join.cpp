#include <poll.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <utility>

#include "core/base/error.h"
#include "core/base/files/text_fields.h"
#include "core/base/printable.h"
#include "core/config/node_kinds.h"
#include "core/config/scenario.h"
#include "launch/command/command.h"
#include "launch/command/common_options.h"
#include "launch/process/file_lock.h"
#include "launch/process/own_address.h"
#include "launch/process/supervisor.h"
#include "launch/run/run_directory.h"
#include "nodes/runtime/observability/status.h"
#include "nodes/runtime/process/event.h"
#include "sensors/frame/recorded_plans.h"
#include "time-master/master.h"

namespace dmise {
namespace {

using Clock_ = std::chrono::steady_clock;

constexpr auto look_every = std::chrono::milliseconds(100);
constexpr double answer_within_s = 0.5;
constexpr int answers_missed = 6;  // in a row: the time-master is gone

struct JoinOptions {
  std::string scenario, node, out, plan, master, keys, host;
  int slot = 0;                       // from 1: index of the sensor or own node; 0: any free one
  std::optional<std::uint64_t> seed;  // instead of the scenario's
  std::vector<std::string> more;      // passed to the node's program
  std::string program;                // that an own node runs, instead of the scenario's
  bool allow_programs = false;
};

/// The kind of which a process is to be any node; null for the name of a node.
const NodeKind* kind_of_any(const std::string& node) {
  for (const NodeKind& kind : node_kinds())
    if ((kind.each_sensor || kind.each_own_node) && node == kind.name) return &kind;
  return nullptr;
}

/// Nodes of a kind that a stack starts: all but those that somebody joins with a program.
std::vector<std::string> started_nodes_of(const NodeKind& kind, const Scenario& scenario) {
  std::vector<std::string> names = nodes_of(kind, scenario);
  for (const OwnNode& node : scenario.own_nodes)
    if (kind.each_own_node && node.run.empty()) std::erase(names, node.name);
  return names;
}

/// One node of a run whose time-master was started elsewhere, by `dmise launch --nodes-elsewhere`.
/// This process is replaced by the node's program, so that its parent sees the node itself.
class Join {
 public:
  Join(const JoinOptions& options, const Scenario& scenario)
      : options_(options), scenario_(scenario) {
    const NodeKind* any = kind_of_any(options.node);
    if (!any) return;
    candidates_ = started_nodes_of(*any, scenario);
    const auto names = nodes_of(*any, scenario);
    asks_as_ = names.empty() ? any->name : names.front();
  }

  /// Returns only if there is nothing (more) to run.
  void run() {
    if (options_.slot > int(candidates_.size())) {
      std::fprintf(stderr, "no %s %d in %s: nothing to do\n", options_.node.c_str(), options_.slot,
                   options_.scenario.c_str());
      return;
    }
    const NodeKind* kind = kind_of_node(options_.node, scenario_);
    const bool not_needed = kind && !kind->wanted(scenario_);
    if (const auto name = fixed_name()) {
      wait_for_master(*name);
      not_needed ? stand_by(*name) : become_node(*name);
    } else if (take_free_node()) {
      wait_for_master(lock_name_);
      become_node(lock_name_);
    } else {
      wait_for_master(asks_as_);
      stand_by(asks_as_);
      if (!lock_name_.empty()) become_node(lock_name_);
    }
  }

 private:
  std::optional<std::string> fixed_name() const {
    if (asks_as_.empty()) return options_.node;
    if (options_.slot > 0) return candidates_[std::size_t(options_.slot - 1)];
    return std::nullopt;
  }

  /// Locks the first free node of the kind.
  bool take_free_node() {
    return std::ranges::any_of(candidates_, [&](const auto& name) { return take(name); });
  }

  bool take(const std::string& name) {
    FileLock lock(options_.out + "/.nodes/" + name + ".lock");
    if (!lock.take()) return false;
    lock_.emplace(std::move(lock));
    lock_name_ = name;
    return true;
  }

  /// The first candidate that the run waits for. After the end of the run none is wanted.
  bool take_wanted_node(const RunStatus& status) {
    std::vector<std::string> wanted = status.missing;
    if (scenario_.network.on_silent_node == OnSilentNode::restart)
      for (const auto& node : status.nodes)
        if (!node.alive) wanted.push_back(node.name);
    return std::ranges::any_of(candidates_, [&](const auto& name) {
      return std::ranges::count(wanted, name) > 0 && take(name);
    });
  }

  Security security_as(const std::string& name) const { return {options_.keys, name}; }

  /// The master answers once the directory of the run is ready. Throws `Error` if it does not
  /// within `join_within_s`.
  void wait_for_master(const std::string& name) {
    const Security security = security_as(name);
    const auto deadline =
        Clock_::now() + std::chrono::duration<double>(scenario_.network.join_within_s);
    while (true) {
      try {
        master_ = numeric_address(options_.master);
        const RunStatus status = ask_master(master_, answer_within_s, security);
        require_same_scenario(status);
        run_id_ = status.run_id;
        return;
      } catch (const ConfigError&) {
        throw;
      } catch (const Error& error) {
        if (Clock_::now() > deadline) throw;
      }
      pause();
    }
  }

  /// Throws `ConfigError` if the run is of another scenario: its products would not be those of
  /// one scenario.
  void require_same_scenario(const RunStatus& status) const {
    if (!status.scenario_digest.empty() && status.scenario_digest != digest_)
      throw ConfigError(options_.scenario + ": is not what the run at " + options_.master +
                        " simulates: scenario, seed, plan or a file differs (digest " + digest_ +
                        ", the run's " + printable(status.scenario_digest, 40) + ")");
  }

  /// Waits until the run is over or a candidate becomes free.
  void stand_by(const std::string& name) {
    std::fprintf(stderr, "%s: no node is missing; standing by\n", options_.node.c_str());
    const Security security = security_as(name);
    int missed = 0;
    while (missed < answers_missed) {
      try {
        const RunStatus status = ask_master(master_, answer_within_s, security);
        if (status.phase == Phase::ended || status.phase == Phase::failed) return;
        if (take_wanted_node(status)) return;
        missed = 0;
      } catch (const Error&) {
        ++missed;
      }
      pause();
    }
  }

  void pause() const {
    pollfd until_stopped{.fd = stop_.fd(), .events = POLLIN, .revents = 0};
    poll(&until_stopped, 1, int(look_every.count()));
    if (stop_.is_set()) throw ExitWith{130};
  }

  bool writes_files(const std::string& name) const {
    const NodeKind* kind = kind_of_node(name, scenario_);
    return kind && dmise::writes_files(*kind, name, scenario_);
  }

  std::vector<std::string> arguments(const std::string& name) const {
    const NodeKind* kind = kind_of_node(name, scenario_);  // null: the broker
    const std::string host = options_.host.empty() ? address_towards(master_) : options_.host;
    std::vector<std::string> all{
        program_directory() + "/" + (kind ? kind->program : "dmise-broker"), "--name", name,
        "--master", master_};
    const auto add = [&](std::initializer_list<std::string> more) { all.insert(all.end(), more); };
    if (!options_.keys.empty()) add({"--keys", options_.keys});
    if (!kind)
      add({"--publish", host, "--subscribe", host, "--observe", host});
    else
      add({"--host", host, "--config", options_.scenario});
    if (writes_files(name)) add({"--out", options_.out});
    if (kind && kind->each_sensor)
      add({"--digest", digest_, "--seed", std::to_string(scenario_.seed)});
    if (kind && kind->each_sensor && !options_.plan.empty()) add({"--plan", options_.plan});
    all.insert(all.end(), options_.more.begin(), options_.more.end());
    if (kind && starts_program(*kind, name, scenario_) && options_.allow_programs)
      add({"--allow-programs"});
    if (options_.program.empty()) return all;
    add({"--"});
    for (auto& word : CLI::detail::split_up(options_.program)) all.push_back(std::move(word));
    return all;
  }

  /// Checks that this run has locked the output directory, or locks it.
  void enter_directory() {
    const auto deadline = Clock_::now() + std::chrono::seconds(10);
    while (true) {
      const auto holder = RunLock::written_in(options_.out);
      if (holder && holder->run_id == run_id_) return;
      try {
        directory_lock_ = std::make_unique<RunLock>(options_.out);
        directory_lock_->set_run_id(run_id_);
        return;
      } catch (const ConfigError&) {
        // A launch learns its run id only after locking.
        if ((holder && holder->run_id != 0) || Clock_::now() > deadline) throw;
      }
      pause();
    }
  }

  [[noreturn]] void become_node(const std::string& name) {
    if (writes_files(name)) enter_directory();
    const std::vector<std::string> command = arguments(name);
    std::fprintf(stderr, "joining %s as %s\n", master_.c_str(), name.c_str());
    // From here on signals end the process, or belong to the node.
    signal(SIGINT, SIG_DFL);
    signal(SIGTERM, SIG_DFL);
    if (signal(SIGHUP, SIG_DFL) == SIG_IGN) signal(SIGHUP, SIG_IGN);  // nohup
    if (stop_.is_set()) throw ExitWith{130};
    if (directory_lock_) directory_lock_->release_to_exec();
    become(command);
  }

  const JoinOptions& options_;
  const Scenario& scenario_;
  const Event& stop_ = stop_signal();
  std::vector<std::string> candidates_;  // for `sensor` and `own-node`: it is to be one of these
  std::string asks_as_;                  // the name of one that stands by for them
  std::optional<FileLock> lock_;
  std::string lock_name_;  // the node locked by this process
  std::string master_;     // numeric address
  std::uint64_t run_id_ = 0;
  const std::string digest_ = scenario_digest(scenario_);
  std::unique_ptr<RunLock> directory_lock_;  // null: the launch locks the directory
};

/// DMISE_SLOT, if it is a number: compose leaves a Swarm's "{{.Task.Slot}}" unexpanded.
int slot_of_environment() {
  const char* text = std::getenv("DMISE_SLOT");
  return text ? parse_integer(trimmed(text)).value_or(0) : 0;
}

/// For the help text: "broker, ... or own-node".
std::string nodes_to_be() {
  std::string all = broker_name;
  for (const NodeKind& kind : node_kinds())
    if (!kind.each_sensor && !kind.each_own_node) all += std::string(", ") + kind.name;
  return all + ", the name of a sensor or an own node, or " + any_sensor + " or " + any_own_node;
}

void join(JoinOptions options) {
  if (options.slot > 0 && !kind_of_any(options.node))
    throw ConfigError(std::string("--slot: is for `") + any_sensor + "` and `" + any_own_node +
                      "`, got " + options.node);
  if (options.slot == 0 && kind_of_any(options.node)) options.slot = slot_of_environment();
  if (options.slot < 0)
    throw ConfigError("DMISE_SLOT: must be from 1, got " + std::to_string(options.slot));
  Scenario scenario = load_scenario(options.scenario);
  if (options.seed) scenario.seed = *options.seed;
  if (!options.plan.empty()) replay_plans(options.plan, scenario);
  if (options.node != broker_name && !kind_of_any(options.node) &&
      !kind_of_node(options.node, scenario))
    throw ConfigError(options.node + ": is not a node of " + options.scenario);
  const NodeKind* kind = kind_of_node(options.node, scenario);
  if (!options.program.empty() && !(kind && kind->each_own_node))
    throw ConfigError("--program: is for a node of `nodes`, got " + options.node);
  Join(options, scenario).run();
}

void add_join_options(CLI::App& command) {
  auto options = std::make_shared<JoinOptions>();
  command.add_option("scenario", options->scenario, "scenario of the run (YAML)")->required();
  command
      .add_option("node", options->node,
                  nodes_to_be() + ": the first free one; a surplus process stands by")
      ->required();
  add_master_option(command, "--master", options->master)->required();
  command.add_option("--out", options->out, "directory of the run, shared by its nodes")
      ->default_val("out/launch");
  command
      .add_option("--slot", options->slot,
                  "for `sensor` and `own-node`: index in the scenario, from 1 (or DMISE_SLOT); a "
                  "surplus process exits at once")
      ->check(CLI::Range(1, 1 << 20));
  command.add_option("--keys", options->keys,
                     "directory of keys (dmise keygen); without it loopback only");
  command
      .add_option("--host", options->host,
                  "where the node's own sockets bind, tcp://A.B.C.D:0; default: this machine's "
                  "address towards the time-master")
      ->check(transport_address());
  add_seed_option(command, options->seed, "as given to the launch");
  command.add_option("--plan", options->plan, "as given to the launch");
  add_allow_programs_flag(command, options->allow_programs);
  command.add_option("--program", options->program,
                     "of an own node: what it runs, instead of the scenario's program: "
                     "\"python3 gnc.py\", from this directory");
  command.allow_extras();  // for the node's program: --threads, --log-level
  command.callback([options, &command] {
    options->more = command.remaining();
    join(*options);
  });
}

}  // namespace

Command join_command() {
  return {.group = CommandGroup::networks,
          .summary = "Runs one node of a run whose time-master is elsewhere",
          .details = "The time-master is that of `dmise launch --nodes-elsewhere`",
          .add_options = add_join_options};
}

}  // namespace dmise
