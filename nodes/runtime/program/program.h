#pragma once
#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <string>

namespace dmise {

/// Flags of every program.
struct CommonFlags {
  std::string name;
  std::string master;                      // address of the time-master
  std::string host = "tcp://127.0.0.1:0";  // where a node's own sockets bind
  std::string keys;                        // directory of keys; empty: no encryption, loopback only
  std::string via;                         // with keys: name of the agent at `master`
  std::string log_level = "info";
  std::string log_format = "text";
  std::string metrics;  // address of metrics: [HOST:]PORT or auto; empty: none
  std::uint64_t seed = 0;
  bool check = false;  // check the flags and files only
};

/// Declares `--name --master --host --keys --via --log-level --log-format --metrics --seed --check
/// --version` with the values in `flags` as defaults.
void add_common_flags(CLI::App& app, CommonFlags& flags);

/// Parses the command line, starts the log and the metrics, runs `body` and returns the process's
/// exit code: that of `body`, 2 for a `ConfigError` or an invalid flag, 1 for any other exception,
/// which is printed as one line on stderr.
int run_program(CLI::App& app, const CommonFlags& flags, int argc, char** argv,
                const std::function<int()>& body);

}  // namespace dmise
