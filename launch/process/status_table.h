#pragma once
#include <string>

#include "nodes/runtime/observability/status.h"

namespace dmise {

/// The clock of a run and its nodes, a line each, for what is no terminal.
std::string status_table(const RunStatus& status);

}  // namespace dmise
