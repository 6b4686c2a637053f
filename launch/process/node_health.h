#pragma once
#include <string>

#include "nodes/runtime/observability/status.h"

namespace dmise {

/// Returns why the process `name` is not healthy according to the time-master; "" if it is. For the
/// time-master itself: why the run is not.
std::string health_problem(const RunStatus& status, const std::string& name);

}  // namespace dmise
