#pragma once
#include <time.h>

#include <algorithm>
#include <type_traits>
#include <vector>

namespace dmise {

inline double seconds_of(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

/// Processor time of this thread, or of all threads of the process [s], which depends little on
/// other processes of the machine.
inline double thread_seconds() { return seconds_of(CLOCK_THREAD_CPUTIME_ID); }
inline double process_seconds() { return seconds_of(CLOCK_PROCESS_CPUTIME_ID); }

/// Median time [s] by a clock of `work`, which may take the number of the repeat.
template <class Work>
double median_seconds(int repeats, Work&& work, double (*clock)() = thread_seconds) {
  std::vector<double> times;
  for (int k = 0; k < repeats; ++k) {
    const double start = clock();
    if constexpr (std::is_invocable_v<Work, int>)
      work(k);
    else
      work();
    times.push_back(clock() - start);
  }
  std::nth_element(times.begin(), times.begin() + repeats / 2, times.end());
  return times[std::size_t(repeats) / 2];
}

}  // namespace dmise
