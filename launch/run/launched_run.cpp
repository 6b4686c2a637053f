#include "launch/run/launched_run.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <filesystem>
#include <optional>
#include <thread>

#include "core/base/error.h"
#include "core/base/files/json_record.h"
#include "core/base/files/paths.h"
#include "core/base/files/text_file.h"
#include "core/base/formatted.h"
#include "core/base/nearest_name.h"
#include "core/base/printable.h"
#include "core/config/make_clock.h"
#include "core/config/node_kinds.h"
#include "core/run/run_files.h"
#include "core/time/iso8601.h"
#include "launch/command/notes.h"
#include "launch/process/host_names.h"
#include "launch/process/metrics_ports.h"
#include "launch/process/own_address.h"
#include "launch/process/restarts.h"
#include "launch/process/supervisor.h"
#include "launch/process/view_process.h"
#include "launch/run/prepare_run.h"
#include "launch/run/progress.h"
#include "launch/run/run_outcome.h"
#include "launch/run/scenario_forecast.h"
#include "nodes/environment/environment_actor.h"
#include "nodes/runtime/observability/status.h"
#include "nodes/runtime/process/event.h"
#include "nodes/runtime/process/last_line.h"
#include "nodes/runtime/process/process_stat.h"
#include "nodes/runtime/program/command_line.h"
#include "orbit-node/orbit_actor.h"
#include "sensors/frame/make_sensor.h"
#include "sensors/frame/recorded_plans.h"

namespace dmise {
namespace {

using Clock_ = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

/// How long the master may be busy without an answer before it counts as lost.
constexpr auto busy_at_most = std::chrono::minutes(1);

std::string number(double x) { return formatted("%.9g", x); }

/// One launch of a scenario as a process per node.
class Launch {
 public:
  Launch(const LaunchOptions& options, const Scenario& scenario, RunDirectory& directory,
         Tick first_tick)
      : options_(options),
        scenario_(scenario),
        directory_(directory),
        first_tick_(first_tick),
        metrics_(options.metrics) {
    for (const auto& sensor : scenario.sensors)
      frames_total_ += static_cast<int>(frames_within(sensor, scenario.duration));
  }

  /// Keeps the live view until Ctrl-C, on a terminal.
  void keep_view() {
    if (!options_.view || !isatty(STDOUT_FILENO) || stop_signal().is_set() || !view_.poll()) return;
    print_note("the live view stays until Ctrl-C");
    pollfd stopped{.fd = stop_signal().fd(), .events = POLLIN, .revents = 0};
    while (poll(&stopped, 1, -1) < 0 && errno == EINTR) {
    }
  }

  RunOutcome run() {
    const auto start = Clock_::now();
    RunOutcome outcome{.how = "a process per node"};
    std::filesystem::create_directories(directory_.path() + "/logs");
    start_master();
    const std::string master = master_address();
    if (options_.view) start_view(master);
    if (!options_.nodes_elsewhere) start_nodes(master);
    metrics_.write_targets(directory_.path() + "/logs/prometheus-targets.json");
    if (options_.view) tell_url();
    watch(master, outcome);
    outcome.wall_s = Seconds(Clock_::now() - start).count();
    return outcome;
  }

 private:
  std::string log_of(const std::string& name) const {
    return directory_.path() + "/logs/" + name + ".log";
  }
  std::string report() const { return directory_.path() + "/logs/master.json"; }
  std::string announcement() const { return directory_.path() + "/logs/master.address"; }

  /// Keeps what the time-masters of earlier parts of the run reported as master-1.json and so on;
  /// removes what is of another run.
  void keep_reports() const {
    std::error_code ignored;
    const auto of_part = [&](int part) {
      return directory_.path() + "/logs/master-" + std::to_string(part) + ".json";
    };
    int part = 1;
    for (; path_exists(of_part(part)); ++part)
      if (first_tick_ == 0) std::filesystem::remove(of_part(part), ignored);
    if (first_tick_ == 0)
      std::filesystem::remove(report(), ignored);
    else
      std::filesystem::rename(report(), of_part(part), ignored);
  }

  void start_master() {
    std::error_code ignored;
    std::filesystem::remove(announcement(), ignored);
    keep_reports();
    const auto& network = scenario_.network;
    const bool restart = network.on_silent_node == OnSilentNode::restart;
    const char* policy = network.on_silent_node == OnSilentNode::fail   ? "fail"
                         : network.on_silent_node == OnSilentNode::drop ? "drop"
                                                                        : "wait";
    start("time-master", "dmise-time-master",
          {"--first-tick",    std::to_string(first_tick_),
           "--real-time",     number(network.real_time),
           "--rejoin-within", number(restart ? network.join_within_s : 0.0),
           "--max-rejoins",   std::to_string(restart ? network.restarts : -1),
           "--report",        report(),
           "--bind",          numeric_address(options_.bind),
           "--announce",      announcement(),
           "--expect",        joined(nodes_of(scenario_), ","),
           "--ticks",         std::to_string(scenario_.last_tick() + 1),
           "--tick-ns",       std::to_string(scenario_.tick.ns),
           "--start",         format_utc(parse_utc(scenario_.start_utc), 6),
           "--digest",        directory_.digest(),
           "--window",        std::to_string(network.window_ticks),
           "--silent-after",  number(network.silent_after_s),
           "--start-within",  number(network.join_within_s),
           "--on-silent",     policy});
  }

  bool is_elsewhere(const std::string& node) const {
    return std::ranges::find(scenario_.own_nodes, node, &OwnNode::name)->run.empty();
  }

  void start_nodes(const std::string& master) {
    start("broker", "dmise-broker", {"--master", master});
    const std::vector<std::string> common{"--config",  options_.scenario,
                                          "--master",  master,
                                          "--threads", std::to_string(options_.threads)};
    for (int host = 0; host < options_.hosts; ++host)
      start(agent_name(scenario_, host), "dmise-host-agent",
            {"--name", agent_name(scenario_, host), "--master", master, "--bind",
             agent_address(host)});
    for (const NodeKind& kind : node_kinds()) {
      const auto nodes = nodes_of(kind, scenario_);
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (kind.each_own_node && is_elsewhere(nodes[i])) continue;  // it joins
        auto arguments = common;
        const auto add = [&](std::initializer_list<std::string> more) {
          arguments.insert(arguments.end(), more);
        };
        if (kind.each_sensor && options_.hosts > 0) {
          const int host = host_of(i, options_.hosts);
          arguments[3] = agent_address(host);
          add({"--via", agent_name(scenario_, host)});
        }
        add({"--name", nodes[i]});
        if (writes_files(kind, nodes[i], scenario_)) add({"--out", directory_.path()});
        if (starts_program(kind, nodes[i], scenario_)) add({"--allow-programs"});
        if (kind.each_sensor)
          add({"--digest", directory_.digest(), "--seed", std::to_string(scenario_.seed)});
        if (kind.each_sensor && !options_.plan.empty()) add({"--plan", options_.plan});
        start(nodes[i], kind.program, arguments);
      }
    }
  }

  /// The gateway is not a process of the run, which goes on if the gateway fails or ends.
  void start_view(const std::string& master) {
    const std::string tokens = options_.keys.empty() ? "" : directory_.path() + "/logs/view.tokens";
    if (!tokens.empty()) operator_token_ = make_view_tokens(tokens);
    std::error_code ignored;
    std::filesystem::remove(view_announcement(), ignored);
    view_.start("gateway",
                gateway_command({.master = master,
                                 .products = directory_.path(),
                                 .keys = options_.keys,
                                 .tokens = tokens,
                                 .announce = view_announcement(),
                                 .truth = options_.view_truth}),
                log_of("gateway"));
  }

  void tell_url() {
    const auto deadline = Clock_::now() + std::chrono::seconds(10);
    while (view_.poll() && Clock_::now() < deadline) {
      if (const auto url = announced_url(view_announcement())) {
        print_note("live view: " + *url +
                   (operator_token_.empty() ? "" : "?token=" + operator_token_));
        return;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    print_note("no live view: " + last_line(log_of("gateway")));
  }

  std::string view_announcement() const { return directory_.path() + "/logs/view.url"; }

  /// Address of an agent for its nodes; a restarted one has the same.
  std::string agent_address(int host) const {
    return "ipc://@dmise-" + std::to_string(getpid()) + "-" + agent_name(scenario_, host);
  }

  void start(const std::string& name, const std::string& program,
             std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), program_directory() + "/" + program);
    if (!options_.keys.empty()) arguments.insert(arguments.end(), {"--keys", options_.keys});
    arguments.insert(arguments.end(), {"--log-format", options_.log_format});
    if (const std::string at = metrics_.next(name); !at.empty())
      arguments.insert(arguments.end(), {"--metrics", at});
    processes_.start(name, arguments, log_of(name));
  }

  /// Waits for the master to announce its address.
  std::string master_address() {
    const auto deadline = Clock_::now() + std::chrono::seconds(10);
    while (Clock_::now() < deadline) {
      if (!processes_.poll()) throw Error("time-master: " + last_line(log_of("time-master")));
      if (std::filesystem::exists(announcement())) {
        std::string address = read_text_file(announcement());
        while (!address.empty() && std::isspace(static_cast<unsigned char>(address.back())))
          address.pop_back();
        if (!address.empty()) return address;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    throw Error("time-master: did not announce its address within 10 s");
  }

  void watch(const std::string& master, RunOutcome& outcome) {
    const Event& stop = stop_signal();
    Progress progress;
    RunStatus status;
    Restarts restarts(processes_, scenario_.network);
    std::optional<Clock_::time_point> first_death;
    auto asked = Clock_::now() - std::chrono::hours(1), next_count = asked;
    auto answered = Clock_::now(), heard = answered, awake = answered;
    while (processes_.poll() && !stop.is_set()) {
      // While this process was suspended it could not receive anything.
      if (Seconds(Clock_::now() - awake).count() > scenario_.network.silent_after_s / 2)
        heard = answered = Clock_::now();
      awake = Clock_::now();
      if (!first_death && processes_.first_failure()) first_death = Clock_::now();
      // The master decides what a dead node means; it has `silent_after_s`, and a little more.
      if (first_death && scenario_.network.on_silent_node == OnSilentNode::fail &&
          Seconds(Clock_::now() - *first_death).count() > scenario_.network.silent_after_s + 2.0) {
        first_cause_ = end_of(*processes_.first_failure());
        break;
      }
      if (Clock_::now() - asked > std::chrono::milliseconds(200)) {
        asked = Clock_::now();
        if (ask(master, status))
          heard = answered = Clock_::now();
        else if (Clock_::now() - heard < busy_at_most && is_busy("time-master"))
          answered = Clock_::now();
        // Counting the frames of many sensors is expensive: at most a twentieth of the time.
        if (const auto begun = Clock_::now(); begun >= next_count && progress.is_due()) {
          progress.show(progress_state(status));
          next_count = begun + 20 * (Clock_::now() - begun);
        }
      }
      // The master is suspended or gone, or remaining nodes do not end.
      if (Seconds(Clock_::now() - answered).count() > scenario_.network.silent_after_s + 2.0) break;
      for (const auto& line : restarts.check(status, Clock_::now())) {
        progress.clear_line();
        print_note(line);
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    progress.clear_line();
    const Child* clock = processes_.find("time-master");
    const bool clock_ended = clock->exit_code.has_value();
    processes_.stop(std::chrono::milliseconds(stop.is_set() ? 1300 : 500));
    outcome.nodes = status.nodes;
    if (clock_ended && read_end(outcome)) return;  // also with a signal after the end
    if (stop.is_set()) {
      outcome.status = "interrupted";
    } else {
      outcome.status = "failed";
      outcome.reason = reason(status, clock_ended) + " (logs in " + directory_.path() + "/logs)";
    }
  }

  /// Whether a process waits for a core or a disk: on a machine with much to do that takes longer
  /// than any answer should, and ends by itself.
  bool is_busy(const std::string& name) const {
    const char state = process_state(processes_.find(name)->pid);
    return state == 'R' || state == 'D';
  }

  /// False if the master does not answer: it is starting, busy or gone.
  bool ask(const std::string& master, RunStatus& status) {
    try {
      status = ask_master(master, 0.5, Security(options_.keys, operator_name));
      directory_.lock().set_run_id(status.run_id);
      return true;
    } catch (const Error&) {
      return false;
    }
  }

  /// Reads the time-master's report of a run that ended in order; false if it did not.
  bool read_end(RunOutcome& outcome) const {
    if (!path_exists(report())) return false;
    const JsonRecord end(read_text_file(report()), report());
    if (end.get<std::string>("status") != "ended") return false;
    outcome.dropped = end.texts("dropped");
    outcome.reason = end.get<std::string>("cause");
    if (!outcome.reason.empty()) outcome.status = "ended";
    if (outcome.dropped.empty()) return true;
    if (outcome.reason.empty())
      outcome.status = "incomplete";
    else
      outcome.reason += "; ";
    outcome.reason += "lost and dropped: " + joined(outcome.dropped, ", ");
    return true;
  }

  ProgressState progress_state(const RunStatus& status) {
    std::optional<Tick> done;
    for (const auto& node : status.nodes)
      if (node.alive && node.name != "broker") done = std::min(done.value_or(node.done), node.done);
    shown_tick_ = std::max({shown_tick_, done.value_or(0), first_tick_ - 1});
    ProgressState state{
        .simulated_s = std::min(scenario_.time_of(shown_tick_), scenario_.duration).seconds(),
        .duration_s = scenario_.duration.seconds(),
        .frames_total = frames_total_};
    for (const auto& sensor : scenario_.sensors) {
      const std::string lines = directory_.path() + "/" + sensor.name;
      state.frames += int(count_lines(path_in(lines, run_file::frames)));
      state.detections += count_lines(path_in(lines, run_file::detections));
    }
    state.waiting_for = joined(status.missing.empty() ? status.holding : status.missing);
    return state;
  }

  /// The first cause of a failure: reported by the master, or the end of the master, or of a node
  /// that died before it could report.
  std::string reason(const RunStatus& status, bool clock_ended) const {
    if (!status.cause.empty()) return status.cause;
    if (clock_ended) {
      const Child& clock = *processes_.find("time-master");
      return *clock.exit_code > killed_by ? end_of(clock) : last_line(clock.log_path);
    }
    if (!first_cause_.empty()) return first_cause_;
    return "time-master has not answered for " + number(scenario_.network.silent_after_s + 2.0) +
           " s";
  }

  const LaunchOptions& options_;
  const Scenario& scenario_;
  RunDirectory& directory_;
  Tick first_tick_;
  Tick shown_tick_ = 0;  // tick of the progress line, which never goes back: nodes leave at the end
  MetricsPorts metrics_;
  Supervisor processes_, view_;
  std::string operator_token_;  // for the view, if the run has keys
  std::string first_cause_;     // if the master cannot report it
  int frames_total_ = 0;
};

bool may_see_truth(const std::string& keys, const std::string& name) {
  const auto allowed = read_allowed(keys);
  const auto key = allowed.find(public_key_of(keys, name));
  return key != allowed.end() && key->second.truth;
}

}  // namespace

void launch(const LaunchOptions& options) {
  if (options.log_format != "text" && options.log_format != "json")
    throw ConfigError("--log-format: must be text or json" +
                      did_you_mean(options.log_format, {"text", "json"}) + ", got " +
                      options.log_format);
  if (!options.metrics.empty()) metrics_address(options.metrics);
  Scenario scenario = load_scenario(options.scenario);
  if (!options.allow_programs && !options.nodes_elsewhere) refuse_programs(scenario.own_nodes);
  if (options.hosts > 0 && scenario.network.on_silent_node == OnSilentNode::drop)
    throw ConfigError("--hosts: agents can't take part in a run with on_silent_node: drop");
  if (options.hosts > 0 && !options.keys.empty())
    check_agent_keys(scenario, options.hosts, options.keys);
  if (options.view_truth && !options.keys.empty() && !may_see_truth(options.keys, "gateway"))
    throw ConfigError("--view-truth: the key of the gateway may not see truth; dmise keygen " +
                      options.keys + " gateway --truth makes one that may");
  if (options.seed) scenario.seed = *options.seed;
  if (!options.plan.empty()) replay_plans(options.plan, scenario);
  // Find errors here, once, before any process starts.
  const ScenarioInputs scene = load_scene(scenario, make_clock(scenario));
  RunDirectory directory(options.out, scenario, scenario_digest(scenario));
  const RunStart begin = prepare_directory(directory, scenario, options.force);
  if (!begin.needed) return;
  stop_signal();
  print_forecast(scenario, scene, make_clock(scenario));
  Launch run(options, scenario, directory, begin.first_tick);
  const RunOutcome outcome = run.run();
  finish_run(directory, scenario, outcome);
  run.keep_view();
}

}  // namespace dmise
