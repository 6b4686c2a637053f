#pragma once

namespace dmise {

/// Orbits from directions: two sites' triangulated positions, the filter's error, consistency and
/// time, and the least-squares fit beside it. Prints one line per value, JSON or text. Returns an
/// exit code.
int bench_fusion(bool json);

}  // namespace dmise
