#pragma once
#include "core/config/scenario.h"
#include "core/time/clock.h"

namespace dmise {

/// Makes the scenario's clock, with its Earth orientation file if it names one.
Clock make_clock(const Scenario& scenario);

}  // namespace dmise
