#pragma once
#include <memory>
#include <string>

#include "core/config/scenario.h"
#include "core/sim/participant.h"
#include "core/time/clock.h"
#include "nodes/own/own_node_run.h"

namespace dmise {

/// Returns the participant that tracks objects. A program without it throws `Error`.
std::unique_ptr<Participant> make_fusion(const Scenario& scenario, const Clock& clock,
                                         const std::string& directory,
                                         const OwnNodeSettings& settings);

}  // namespace dmise
