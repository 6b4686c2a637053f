#pragma once
#include <nanobind/nanobind.h>

#include <atomic>
#include <chrono>
#include <exception>
#include <functional>
#include <future>
#include <memory>
#include <utility>

#include "core/base/cancellation.h"
#include "core/base/detached_work.h"

namespace dmise {

/// How long Python's signals wait.
inline constexpr std::chrono::milliseconds signal_interval{50};

/// Calls `wait` without the GIL until it returns true. Throws Python's exception, after `cancel`,
/// for a signal whose handler raises one, such as Ctrl-C.
inline void wait_interruptibly(const std::function<bool(std::chrono::milliseconds)>& wait,
                               const std::function<void()>& cancel) {
  for (;;) {
    bool done = false;
    {
      nanobind::gil_scoped_release without;
      done = wait(signal_interval);
    }
    if (done) return;
    if (PyErr_CheckSignals() != 0) {
      cancel();
      throw nanobind::python_error();
    }
  }
}

/// Returns what `work` returns. It runs in a thread of its own, without the GIL, and must own what
/// it uses: after a signal it is cancelled and left to end alone.
template <class Result>
Result interruptible(std::function<Result()> work) {
  struct Shared {
    std::atomic<bool> cancelled = false;
    std::promise<Result> result;
  };
  auto shared = std::make_shared<Shared>();
  auto future = shared->result.get_future();
  start_detached([shared, work = std::move(work)] {
    CancellationScope scope(shared->cancelled);
    try {
      shared->result.set_value(work());
    } catch (...) {
      shared->result.set_exception(std::current_exception());
    }
  });
  wait_interruptibly([&](auto time) { return future.wait_for(time) == std::future_status::ready; },
                     [&] { shared->cancelled = true; });
  return future.get();
}

}  // namespace dmise
