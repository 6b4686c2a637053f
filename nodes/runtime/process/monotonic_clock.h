#pragma once
#include "core/base/instant.h"

namespace dmise {

/// Returns the monotonic wall clock.
inline Instant now() { return std::chrono::steady_clock::now().time_since_epoch(); }

}  // namespace dmise
