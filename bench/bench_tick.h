#pragma once

namespace dmise {

/// Lock-step ticks per second with 2, 4, 8 and 16 node processes on this machine over tcp, window
/// 1, beside the floor measured in the same run: a bare ZeroMQ PUB answered over PUSH by as many
/// bare processes. Prints a line a figure, JSON or text. Returns an exit code. Call it while the
/// process has one thread: it forks.
int bench_tick(bool json);

}  // namespace dmise
