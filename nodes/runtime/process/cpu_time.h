#pragma once
#include <ctime>

namespace dmise {

/// Returns the CPU seconds of all threads of this process.
inline double process_cpu_seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

}  // namespace dmise
