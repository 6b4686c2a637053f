#pragma once
#include "core/sim/message.h"

namespace dmise {

/// Whether a message holds for the whole run, so that late subscribers need it as well.
inline bool is_retained(const State& state) { return std::holds_alternative<ObjectRoster>(state); }

}  // namespace dmise
