#pragma once
#include "core/config/scenario.h"

namespace dmise {

/// Gives the objects that move near another (`motion: {proximity: ..}`) their trajectories, over
/// the run and some minutes on either side, from the motion of their chiefs, which has been read
/// and flown. Adds warnings. Throws `ConfigError` at an object whose chief is none or has no orbit
/// for the motion.
void place_deputies(Scenario& scenario);

}  // namespace dmise
