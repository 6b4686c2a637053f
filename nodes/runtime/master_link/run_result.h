#pragma once
#include <spdlog/spdlog.h>

#include "core/base/error.h"

namespace dmise {

/// Returns the result that `run(&result)` fills in. An exception sets `exit_code`, 2 for a
/// `ConfigError`, else 1, and `reason`, and is logged.
template <class Result, class Run>
Result result_of_run(const Run& run) {
  Result result;
  try {
    run(&result);
  } catch (const ConfigError& error) {
    result.exit_code = 2;
    result.reason = error.what();
  } catch (const std::exception& error) {
    result.exit_code = 1;
    result.reason = error.what();
  }
  if (result.exit_code != 0) spdlog::error("{}", result.reason);
  return result;
}

}  // namespace dmise
