#pragma once
#include <chrono>
#include <functional>

namespace dmise {

/// Calls `work`, which throws nothing and owns what it uses, in a thread that nobody waits for.
/// Throws `std::system_error` where there can be no more threads.
void start_detached(std::function<void()> work);

/// Returns whether all such work has ended, after waiting for it at most that long. A program calls
/// it before it ends, for what the threads use ends with it.
bool wait_for_detached(std::chrono::milliseconds time);

}  // namespace dmise
