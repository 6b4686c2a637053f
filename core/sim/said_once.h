#pragma once
#include "core/sim/message.h"

namespace dmise {

/// True for what holds for a whole run from when it is said: whoever comes later needs it as well.
inline bool said_once(const State& state) { return std::holds_alternative<ObjectRoster>(state); }

}  // namespace dmise
