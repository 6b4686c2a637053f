#pragma once
#include "core/sim/message.h"

namespace dmise {

/// Returns true for what holds for a whole run: who subscribes later needs it as well.
inline bool is_retained(const State& state) { return std::holds_alternative<ObjectRoster>(state); }

}  // namespace dmise
