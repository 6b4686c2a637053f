#pragma once

namespace dmise {

/// Ticks per second of runs with actors in Python: `dmise run` with one object and with 20,000 of
/// one program, and `dmise launch` with 16 programs compared to as many nodes that do nothing.
/// Prints one line per value, JSON or text. Returns an exit code. Throws `Error` if no python3 of
/// the PATH has the package. Must be called while the process has one thread, because it forks.
int bench_nodes(bool json);

}  // namespace dmise
