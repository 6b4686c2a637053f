#pragma once
#include <CLI/CLI.hpp>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "nodes/runtime/program/command_line.h"

// Options that several commands have. What the variable holds is the default.
namespace dmise {

/// Adds `name`, a number from `low` to `high`.
inline CLI::Option* add_number_option(CLI::App& command, const std::string& name, double& number,
                                      double low, double high, const std::string& what) {
  return command.add_option(name, number, what)
      ->capture_default_str()
      ->check(number_between(low, high));
}

/// Adds `--threads`, 1 to 256.
inline CLI::Option* add_threads_option(CLI::App& command, int& threads,
                                       const std::string& what = "number of threads") {
  return command.add_option("--threads", threads, what)
      ->capture_default_str()
      ->check(CLI::Range(1, 256));
}

/// The range of a scenario's `simulation.seed`.
inline CLI::Range seed_range() {
  return {std::uint64_t{0}, std::uint64_t(std::numeric_limits<std::int64_t>::max())};
}

/// Adds `--seed`, within the range of a scenario's `simulation.seed`.
inline CLI::Option* add_seed_option(CLI::App& command, std::optional<std::uint64_t>& seed,
                                    const std::string& what) {
  return command.add_option("--seed", seed, what)->check(seed_range());
}

/// Adds `--allow-programs`.
inline CLI::Option* add_allow_programs_flag(CLI::App& command, bool& allowed) {
  return command.add_flag("--allow-programs", allowed,
                          "start the programs that `nodes` of the scenario names: they can do "
                          "whatever you can");
}

/// Adds `name`, the address of the time-master.
inline CLI::Option* add_master_option(CLI::App& command, const std::string& name,
                                      std::string& master) {
  return command.add_option(name, master, "address of the time-master, tcp://HOST:PORT")
      ->check(transport_address());
}

}  // namespace dmise
