#pragma once
#include <string>

#include "core/config/scenario.h"

namespace dmise {

/// Reads and checks a scenario as `load_scenario` does; `name` stands for its path. Defined beside
/// that.
Scenario scenario_of_text(const std::string& text, const std::string& name);

}  // namespace dmise
