#pragma once
#include <nanobind/nanobind.h>

#include <string>

#include "core/base/error.h"

// The parts of the module `dmise._engine`, which clients/python wraps. What is JSON here is as the
// command line prints it.
namespace dmise {

/// Invalid input that is a scenario.
class ScenarioFault : public ConfigError {
 public:
  using ConfigError::ConfigError;
};

/// Returns what `f` returns; a `ConfigError` becomes a `ScenarioFault`.
template <class F>
auto of_scenario(const F& f) {
  try {
    return f();
  } catch (const ConfigError& error) {
    throw ScenarioFault(error.what());
  }
}

/// Throws `ConfigError` for what is no number of threads.
inline int checked_threads(int threads) {
  if (threads < 1 || threads > 1024)
    throw ConfigError("threads: must be in 1..1024, got " + std::to_string(threads));
  return threads;
}

void add_simulation(nanobind::module_& module);
void add_frames_of_cameras(nanobind::module_& module);
void add_catalogues(nanobind::module_& module);
void add_samples(nanobind::module_& module);

}  // namespace dmise
