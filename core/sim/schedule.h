#pragma once
#include <algorithm>

#include "core/base/sim_time.h"

namespace dmise {

/// The ticks at which a participant works: offset, offset + period, offset + 2 period, ...
struct Schedule {
  Tick period = 1;  // >= 1
  Tick offset = 0;  // >= 0

  /// First tick of work after `tick`.
  Tick next_after(Tick tick) const {
    return tick < offset ? offset : offset + ((tick - offset) / period + 1) * period;
  }
  bool due(Tick tick) const { return next_after(tick - 1) == tick; }

  bool operator==(const Schedule&) const = default;
};

}  // namespace dmise
