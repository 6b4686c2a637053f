#pragma once

namespace dmise {

/// Lock-step ticks per second with 2, 4, 8 and 16 node processes on this machine over tcp, window
/// 1, and the floor measured in the same run: a bare ZeroMQ PUB answered over PUSH by as many bare
/// processes. Prints one line per value, JSON or text. Returns an exit code. Must be called while
/// the process has one thread, because it forks.
int bench_tick(bool json);

}  // namespace dmise
