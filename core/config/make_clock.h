#pragma once
#include "core/config/scenario.h"
#include "core/time/clock.h"

namespace dmise {

/// The scenario's clock, with its Earth orientation file if it names one.
Clock make_clock(const Scenario& scenario);

}  // namespace dmise
