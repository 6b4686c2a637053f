#pragma once
#include <string>

#include "nodes/runtime/observability/status.h"

namespace dmise {

/// Why the process `name` is no healthy part of its run, as the time-master sees it; "" if it is.
/// Of the time-master itself: why the run is not.
std::string complaint_of(const RunStatus& status, const std::string& name);

}  // namespace dmise
