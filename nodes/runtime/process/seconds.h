#pragma once
#include <chrono>

#include "core/base/instant.h"

namespace dmise {

/// Rounded towards zero to nanoseconds.
inline Instant from_seconds(double seconds) {
  return std::chrono::duration_cast<Instant>(std::chrono::duration<double>(seconds));
}

inline double to_seconds(Instant t) { return std::chrono::duration<double>(t).count(); }

}  // namespace dmise
