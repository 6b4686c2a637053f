#include <poll.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>

#include "core/base/error.h"
#include "core/base/formatted.h"
#include "core/base/printable.h"
#include "core/time/iso8601.h"
#include "launch/command/command.h"
#include "launch/command/common_options.h"
#include "launch/command/notes.h"
#include "launch/observatory/run_clock.h"
#include "launch/run/prepare_run.h"
#include "launch/run/resume_point.h"
#include "nodes/runtime/process/event.h"
#include "nodes/runtime/process/host_port.h"
#include "sensors/alpaca/alpaca_server.h"
#include "sensors/alpaca/discovery.h"
#include "sensors/indi/indi_server.h"
#include "sensors/observatory/commanded_frames.h"

namespace dmise {
namespace {

struct ObservatoryOptions {
  std::string scenario, out, commands, listen = "127.0.0.1:11111", tokens;
  std::string indi;                // empty: not served
  std::optional<std::string> run;  // whose time the night has; none: the clock of this machine
  std::string keys;
  std::optional<std::uint64_t> seed;  // instead of the scenario's
  ObservatorySettings devices;
  double rate = 1.0;
  int discovery_port = alpaca_discovery_port;
  bool no_discovery = false, connected = false, force = false;
};

HostPort address_of(const std::string& option, const std::string& text) {
  const auto address = host_and_port(text);
  if (!address) throw ConfigError(option + ": must be HOST:PORT or [IPv6]:PORT, got " + text);
  return *address;
}

AlpacaServerOptions alpaca_options(const ObservatoryOptions& options) {
  const HostPort address = address_of("--listen", options.listen);
  AlpacaServerOptions server{.host = address.host, .location = options.scenario};
  server.port = std::uint16_t(address.port);
  server.connected = options.connected;
  if (!options.tokens.empty()) server.tokens = read_access_tokens(options.tokens);
  server.discovery_port = options.no_discovery ? 0 : options.discovery_port;
  return server;
}

/// The servers of an observatory. They are bound before anything is written.
struct Doors {
  explicit Doors(const ObservatoryOptions& options)
      : alpaca_host(address_of("--listen", options.listen).host), alpaca(alpaca_options(options)) {
    if (options.indi.empty()) return;
    const HostPort address = address_of("--indi", options.indi);
    indi_host = address.host;
    indi.emplace(IndiServerOptions{.host = indi_host, .port = std::uint16_t(address.port)});
  }

  void serve(Observatory& observatory) {
    alpaca.serve(observatory);
    if (indi) indi->serve(observatory);
  }
  /// Tells where they are.
  void print() const {
    if (!alpaca.not_discovered().empty())
      print_note("clients do not find it by discovery: " + alpaca.not_discovered());
    std::string text =
        "ASCOM Alpaca at http://" + text_of(HostPort{alpaca_host, alpaca.port()}) + "/setup";
    if (indi) text += ", INDI at " + text_of(HostPort{indi_host, indi->port()});
    std::printf("%s; Ctrl-C ends the night\n", text.c_str());
    std::fflush(stdout);
  }

  std::string alpaca_host, indi_host;
  AlpacaServer alpaca;
  std::optional<IndiServer> indi;
};

/// Reads a scenario and leaves what is commanded.
Scenario load_commanded(const ObservatoryOptions& options) {
  Scenario scenario = load_scenario(options.scenario);
  if (options.seed) scenario.seed = *options.seed;
  check_observatory(scenario);
  auto sensors = commanded_sensors(scenario);
  if (sensors.size() < scenario.sensors.size())
    print_note("only cameras at sites are commanded: " + std::to_string(sensors.size()) + " of " +
               std::to_string(scenario.sensors.size()) + " sensors");
  scenario.sensors = std::move(sensors);
  scenario.fusion.reset();
  scenario.network.publish_states = false;  // nobody outside this process can take them
  return scenario;
}

/// What there is to say of a scenario wherever its cameras point.
void print_notes(const Scenario& scenario, const ScenarioInputs& scene) {
  for (const std::string& warning : scenario.warnings) print_warning(warning);
  for (const std::string& note : scene.population.notes) print_note(note);
  for (const std::string& note : make_clock(scenario).warnings(scenario.duration)) print_note(note);
}

/// Empties the directory, or refuses one that has products. Nights are never continued.
void take_directory(RunDirectory& directory, bool force) {
  directory.check_sensor_directories();
  const bool used =
      directory.content() != RunDirectory::Content::no_run || !directory.in_the_way().empty();
  if (used && !force)
    throw ConfigError(directory.path() +
                      ": contains products; --force replaces them, --out writes elsewhere");
  if (used) directory.clear(true);
  mark_begun(directory, {});
}

/// The clock of the run that the options name; null without.
std::unique_ptr<RunClock> run_clock(const ObservatoryOptions& options, const Scenario& scenario) {
  if (!options.run) return nullptr;
  auto clock = std::make_unique<RunClock>(*options.run, Security(options.keys, operator_name));
  const std::string start = format_utc(parse_utc(scenario.start_utc), 6);
  if (!clock->start_utc().empty() && clock->start_utc() != start)
    throw ConfigError("--run: the run begins at " + printable(clock->start_utc()) + ", " +
                      options.scenario + " at " + start);
  return clock;
}

/// Waits for Ctrl-C, or for the end of the run; returns why the run has ended, if it has.
std::string wait_for_end(const RunClock* run) {
  pollfd stop{.fd = stop_signal().fd(), .events = POLLIN, .revents = 0};
  while (!stop_signal().is_set()) {
    if (run && !run->ended().empty()) return run->ended();
    poll(&stop, 1, run ? 100 : 1000);
  }
  return {};
}

RunOutcome serve(const ObservatoryOptions& options, std::unique_ptr<Doors> doors,
                 const RunClock* run, const Scenario& scenario, const ScenarioInputs& scene,
                 const RunDirectory& directory) {
  RunOutcome outcome{.how = "an observatory"};
  std::atomic<bool> failed = false;
  const WallClock wall_clock(options.rate);
  const ObservatoryClock& clock = run ? static_cast<const ObservatoryClock&>(*run) : wall_clock;
  {
    Observatory observatory(scenario, scene, directory.digest(), directory.path(), options.devices,
                            clock, [&](const std::string& reason) {
                              failed = true;
                              print_warning(reason);
                            });
    doors->serve(observatory);
    doors->print();
    if (const std::string end = wait_for_end(run); !end.empty())
      print_note("the night ends: " + printable(end));
    doors.reset();  // before what they serve
  }
  if (failed) {
    outcome.status = "failed";
    outcome.reason = "a frame could not be made or written";
  }
  return outcome;
}

RunOutcome replay(const ObservatoryOptions& options, const std::vector<CommandedExposure>& night,
                  const Scenario& scenario, const ScenarioInputs& scene,
                  const RunDirectory& directory) {
  RunOutcome outcome{.how = "an observatory's commands"};
  try {
    replay_night(scenario, scene, night, directory.digest(), directory.path(),
                 options.devices.threads,
                 [](const CommandedExposure&) { return !stop_signal().is_set(); });
    if (stop_signal().is_set()) outcome.status = "interrupted";
  } catch (const Error& error) {
    outcome.status = "failed";
    outcome.reason = error.what();
  }
  return outcome;
}

void observe(const ObservatoryOptions& options) {
  const Scenario scenario = load_commanded(options);
  const ScenarioInputs scene = load_scene(scenario, make_clock(scenario));
  std::vector<CommandedExposure> night;
  std::unique_ptr<Doors> doors;
  std::unique_ptr<RunClock> run;
  if (options.commands.empty()) {
    run = run_clock(options, scenario);
    doors = std::make_unique<Doors>(options);
  } else {
    night = read_night(options.commands, scenario);
    print_note(counted(night.size(), "exposure") + " of " + options.commands);
  }
  print_notes(scenario, scene);
  RunDirectory directory(options.out, scenario, scenario_digest(scenario));
  take_directory(directory, options.force);
  stop_signal();
  const auto start = std::chrono::steady_clock::now();
  RunOutcome outcome = doors
                           ? serve(options, std::move(doors), run.get(), scenario, scene, directory)
                           : replay(options, night, scenario, scene, directory);
  outcome.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  finish_run(directory, scenario, outcome);
}

void add_observatory_options(CLI::App& command) {
  auto options = std::make_shared<ObservatoryOptions>();
  command.add_option("scenario", options->scenario, "scenario (YAML)")->required();
  command.add_option("--out", options->out, "directory of the products")
      ->default_val("out/observatory");
  auto* commands = command.add_option(
      "--commands", options->commands,
      "night.jsonl of an observatory: makes its products again, without a server");
  command
      .add_option("--listen", options->listen,
                  "IP address and port; port 0: any free port; addresses other than loopback need "
                  "--tokens")
      ->capture_default_str();
  command
      .add_option(
          "--indi", options->indi,
          "serves INDI as well, at this loopback address and port; 127.0.0.1:7624 if none is "
          "given; INDI knows no tokens")
      ->expected(0, 1)
      ->default_str("127.0.0.1:" + std::to_string(indi_port));
  command.add_option("--tokens", options->tokens,
                     "file with `view TOKEN` and `operator TOKEN`: who may read, also command; the "
                     "token is the password");
  command
      .add_option("--discovery-port", options->discovery_port,
                  "UDP port at which clients ask for servers")
      ->capture_default_str()
      ->check(CLI::Range(1, 65535));
  command.add_flag("--no-discovery", options->no_discovery, "clients must know the address");
  command.add_flag("--connected", options->connected,
                   "Alpaca's devices are connected from the beginning, for clients that take this "
                   "for granted");
  auto* rate = add_number_option(command, "--rate", options->rate, 0.01, 1000.0,
                                 "simulated seconds per second");
  auto* run = command.add_option("--run", options->run,
                                 "address of the time-master of a paced run that begins when the "
                                 "scenario does: the night has its time, and ends with it");
  run->excludes(rate)->excludes(commands);
  command.add_option("--keys", options->keys, "directory with operator.key, for --run")->needs(run);
  add_number_option(command, "--slew-rate", options->devices.slew_rate_deg_per_s, 0.01, 100.0,
                    "of the telescopes [deg/s]");
  add_number_option(command, "--settle", options->devices.settle_s, 0.0, 100.0,
                    "of the telescopes after a slew [s]");
  add_number_option(command, "--readout", options->devices.readout_s, 0.0, 100.0,
                    "between the end of an exposure and its image [s]");
  add_threads_option(command, options->devices.threads,
                     "number of threads of each camera; the products do not depend on it");
  add_seed_option(command, options->seed, "seed of the random numbers, instead of the scenario's");
  command.add_flag("--force", options->force, "replace the products in the directory");
  command.callback([options] { observe(*options); });
}

}  // namespace

Command observatory_command() {
  return {.group = CommandGroup::networks,
          .summary =
              "Lets an observatory's software use a scenario's cameras, by ASCOM Alpaca and INDI",
          .add_options = add_observatory_options};
}

}  // namespace dmise
