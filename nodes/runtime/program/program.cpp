#include "nodes/runtime/program/program.h"

#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <optional>

#include "core/base/error.h"
#include "nodes/runtime/observability/metrics.h"
#include "nodes/runtime/process/log.h"
#include "nodes/runtime/program/command_line.h"
#include "nodes/runtime/program/manual.h"
#include "nodes/runtime/program/version_text.h"

namespace dmise {
namespace {

/// Raises the limit of open files as far as the system permits, to at most 65,536: each connection
/// is one, and the usual soft limit is 1,024.
void raise_file_limit() {
  constexpr rlim_t enough = 65536;
  rlimit files{};
  if (getrlimit(RLIMIT_NOFILE, &files) != 0 || files.rlim_cur >= enough) return;
  files.rlim_cur = std::min(files.rlim_max, enough);  // RLIM_INFINITY is the largest
  setrlimit(RLIMIT_NOFILE, &files);
}

}  // namespace

void add_common_flags(CLI::App& app, CommonFlags& flags) {
  app.add_option("--name", flags.name, "name of this node in the run")->capture_default_str();
  app.add_option("--master", flags.master, "address of the time-master, tcp://HOST:PORT")
      ->capture_default_str()
      ->check(transport_address());
  app.add_option("--host", flags.host,
                 "where this node's own sockets bind, reachable by others; port 0: any")
      ->capture_default_str()
      ->check(transport_address());
  app.add_option("--keys", flags.keys,
                 "directory of keys (dmise keygen); without it no encryption, loopback only");
  app.add_option("--via", flags.via,
                 "with keys: name of the agent whose address --master is, if it is not the "
                 "time-master's own");
  app.add_option("--log-level", flags.log_level, "trace, debug, info, warning, error or off")
      ->capture_default_str();
  app.add_option("--log-format", flags.log_format, "text or json (one object per line)")
      ->capture_default_str();
  app.add_option("--metrics", flags.metrics,
                 "serve Prometheus metrics at [HOST:]PORT, or auto: any free port; the host is "
                 "127.0.0.1 unless given");
  app.add_option("--seed", flags.seed, "seed of all random numbers")->capture_default_str();
  app.add_flag("--check", flags.check, "check flags and files, then exit");
  const std::string version = version_text(app.get_name());
  app.set_version_flag("--version", version);
  app.add_flag_callback(
         "--man",
         [&app, version] {
           std::printf("%s", manual_page(app, app.get_name(), version, {"dmise"}).c_str());
           throw CLI::Success();
         },
         "print the manual page")
      ->group("");  // for the build, which makes pages of it
}

int run_program(CLI::App& app, const CommonFlags& flags, int argc, char** argv,
                const std::function<int()>& body) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return end_of_command_line(app, error);
  }
  try {
    const std::string name = flags.name.empty() ? app.get_name() : flags.name;
    start_log(name, flags.log_level, flags.log_format);
    raise_file_limit();
    std::optional<Metrics> metrics;
    if (!flags.metrics.empty() && !flags.check)
      metrics.emplace(flags.metrics, app.get_name(), name);
    else if (!flags.metrics.empty())
      metrics_address(flags.metrics);
    return body();
  } catch (const ConfigError& error) {
    spdlog::error("{}", error.what());
    return 2;
  } catch (const std::exception& error) {
    spdlog::error("{}", error.what());
    return 1;
  }
}

}  // namespace dmise
