#pragma once
#include <string>

#include "core/config/scenario.h"

namespace dmise {

/// Takes the plans of the frames of a finished run from its run.json, to be replayed: each frame of
/// each sensor runs at the same levels. Throws `ConfigError` with the file and what is wrong: it is
/// no run.json, its frames were not planned, or a frame, an effect or a level does not fit the
/// scenario.
void replay_plans(const std::string& run_json, Scenario& scenario);

}  // namespace dmise
