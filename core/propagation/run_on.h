#pragma once
#include "core/sim/state.h"

namespace dmise {

/// The environment at `t`, up to an hour after `state`: Sun, Moon and Earth by `advance`; the
/// orientation keeps its own time and runs on by its own rates.
EnvironmentState run_on(EnvironmentState state, SimTime t);

}  // namespace dmise
