#pragma once
#include <cstdint>
#include <optional>
#include <string>

namespace dmise {

struct LaunchOptions {
  std::string scenario, out, plan, bind = "tcp://127.0.0.1:0", keys;
  std::optional<std::uint64_t> seed;  // instead of the scenario's
  int threads = 1;
  int hosts = 0;  // > 0: number of agents for the sensors
  bool force = false;
  bool allow_programs = false;               // the scenario's nodes may be programs
  std::string metrics, log_format = "text";  // how every process reports
  bool nodes_elsewhere = false;              // nodes are started by `dmise join`
  bool view = false;                         // a gateway shows the run to browsers
  bool view_truth = false;                   // also its truth
};

/// Runs a scenario as a process per node until it is complete and, with a view on a terminal, until
/// Ctrl-C. Throws `ConfigError` for options and scenarios that cannot run, `Error` if the run
/// fails.
void launch(const LaunchOptions& options);

}  // namespace dmise
