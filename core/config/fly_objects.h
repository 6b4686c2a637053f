#pragma once
#include "core/config/scenario.h"

namespace dmise {

/// Integrates the paths of the objects that fly by numerical integration or manoeuvre, over the run
/// and some minutes on either side: their models become trajectories. Until its first manoeuvre an
/// object moves as stated. Adds warnings. Throws `ConfigError` at an object that has no path: its
/// stated motion has no state at the first manoeuvre, or it ends before the run.
void fly_objects(Scenario& scenario);

}  // namespace dmise
