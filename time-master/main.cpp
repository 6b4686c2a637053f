// dmise-time-master: runs the clock of one run, from the first node that joins to the last tick.
#include "core/base/files/whole_file.h"
#include "nodes/runtime/process/seconds.h"
#include "nodes/runtime/program/command_line.h"
#include "nodes/runtime/program/program.h"
#include "time-master/master.h"

int main(int argc, char** argv) {
  dmise::CommonFlags flags{.name = "time-master"};
  dmise::MasterOptions options;
  dmise::Tick ticks = 1;
  std::string report, on_silent = "fail";
  double silent_after_s = 5.0, progress_after_s = 900.0, stalled_after_s = 60.0,
         start_within_s = 0.0, rejoin_within_s = 0.0;
  CLI::App app("Runs the clock of one run.", "dmise-time-master");
  dmise::add_common_flags(app, flags);
  app.add_option("--bind", options.address, "address that all processes connect to; port 0: any")
      ->capture_default_str()
      ->check(dmise::transport_address());
  app.add_option("--announce", options.announce_file, "file to write the address to");
  app.add_option("--announce-fd", options.announce_fd, "file descriptor to write the address to");
  app.add_option("--report", report, "file for the outcome of the run, in JSON");
  app.add_option("--expect", options.run.expected,
                 "names of the nodes that the clock waits for: a,b,c")
      ->required()
      ->delimiter(',');
  app.add_flag("!--no-broker", options.with_broker, "run without a broker: no topics");
  app.add_option("--ticks", ticks, "number of ticks")->capture_default_str();
  app.add_option("--tick-ns", options.tick_length.ns, "length of a tick")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--start", options.start_utc, "UTC of the first tick (ISO 8601), for observers");
  app.add_option("--digest", options.scenario_digest, "digest of the scenario, for those who join");
  app.add_option("--window", options.run.window_ticks, "ticks that a node may run ahead")
      ->capture_default_str();
  app.add_option("--silent-after", silent_after_s, "silence after which a node is lost [s]")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--progress-after", progress_after_s,
                 "time without progress after which a step is hung [s]; 0: no limit")
      ->capture_default_str();
  app.add_option("--stalled-after", stalled_after_s,
                 "longest time that a node is neither computing nor done although its inputs "
                 "are published [s]; 0: no limit")
      ->capture_default_str();
  app.add_option("--start-within", start_within_s,
                 "longest wait for all nodes to be ready [s]; 0: no limit")
      ->capture_default_str();
  const std::map<std::string, dmise::SilentPolicy> policies{{"fail", dmise::SilentPolicy::fail},
                                                            {"wait", dmise::SilentPolicy::wait},
                                                            {"drop", dmise::SilentPolicy::drop}};
  app.add_option("--on-silent", on_silent,
                 "what a lost node means: fail, wait (for it, or another process of its name) or "
                 "drop (continue without it)")
      ->capture_default_str()
      ->check(dmise::one_of({"fail", "wait", "drop"}));
  app.add_option("--rejoin-within", rejoin_within_s,
                 "longest wait for a lost node [s]; 0: no limit")
      ->capture_default_str();
  app.add_option("--max-rejoins", options.run.max_rejoins,
                 "restarts allowed per node; -1: any number")
      ->capture_default_str();
  app.add_option("--first-tick", options.run.first_tick,
                 "tick to start at, to continue an interrupted run")
      ->capture_default_str();
  app.add_option("--real-time", options.run.pace.factor,
                 "simulated seconds per second; 0: as fast as possible")
      ->capture_default_str();
  return dmise::run_program(app, flags, argc, argv, [&] {
    options.run.last_tick = ticks - 1;
    options.run.silent_after = dmise::from_seconds(silent_after_s);
    options.run.progress_after = dmise::from_seconds(progress_after_s);
    options.run.stalled_after = dmise::from_seconds(stalled_after_s);
    options.run.start_within = dmise::from_seconds(start_within_s);
    options.run.rejoin_within = dmise::from_seconds(rejoin_within_s);
    options.run.on_silent = policies.at(on_silent);
    options.keys = flags.keys;
    options.stop = &dmise::stop_signal();
    if (flags.check) return dmise::Coordinator(options.run).over() ? 1 : 0;
    const dmise::MasterResult result = dmise::run_master(options);
    if (!report.empty()) dmise::write_file_whole(report, dmise::to_json(result) + "\n");
    return result.exit_code;
  });
}
