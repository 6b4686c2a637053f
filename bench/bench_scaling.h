#pragma once

namespace dmise {

/// Networks of 2 to 200 sensor nodes that do nothing but take part, each a process, with orbit
/// node, broker and time-master, as fast as possible: ticks a second, processor time of each
/// program and bytes a tick. Once with empty states (the barrier alone), once with the states of
/// 18,470 objects, once with empty states at a pace, which shows what time alone costs.
/// bench/scaling.py fits and extends what this measures.
int bench_scaling(bool json);

}  // namespace dmise
