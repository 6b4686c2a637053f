#pragma once
#include <cstddef>
#include <functional>
#include <string>

namespace dmise {

/// How work by processes ended.
struct WorkOutcome {
  bool interrupted = false;      // `go_on` said so
  std::string failure;           // of the first item that failed; empty: none
  bool is_config_error = false;  // of the failure
};

/// Calls `work(item)` for the items 0..items-1 in `workers` processes that are forked from this one
/// and share what it has loaded; each takes the next item when it is done with one. What an item
/// makes must be left in files. `go_on(done)` is called here about every 50 ms, with the number of
/// items that are done: false ends the workers at once. The first failure ends them too. Call it
/// from a process with one thread. Throws `Error` if processes can't be made.
WorkOutcome work_in_processes(std::size_t items, int workers,
                              const std::function<void(std::size_t)>& work,
                              const std::function<bool(std::size_t done)>& go_on);

}  // namespace dmise
