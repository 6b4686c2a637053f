#pragma once
#include <cstddef>
#include <functional>
#include <string>

namespace dmise {

/// Result of `work_in_processes`.
struct WorkOutcome {
  bool interrupted = false;      // by `go_on`, or by a signal
  std::string failure;           // why the first item that failed did; empty: none failed
  bool is_config_error = false;  // it was a `ConfigError`
};

/// Calls `work(item)` for the items 0..items-1 in `workers` processes that are forked from this one
/// and share its memory; each takes the next item when it has done one. Results must be written to
/// files. `go_on(done)` is called in this process about every 50 ms, with the number of items that
/// are done: if it returns false, the workers end at once. The first failure ends them too. Call it
/// from a process with one thread. Throws `Error` if processes can't be made.
WorkOutcome work_in_processes(std::size_t items, int workers,
                              const std::function<void(std::size_t)>& work,
                              const std::function<bool(std::size_t done)>& go_on);

}  // namespace dmise
