#pragma once
#include <chrono>

namespace dmise {

/// Wall-clock time since any fixed instant.
using Instant = std::chrono::nanoseconds;

}  // namespace dmise
