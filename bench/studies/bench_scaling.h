#pragma once

namespace CLI {
class App;
}

namespace dmise {

/// Networks of 2 to 200 idle sensor nodes, each a process, with orbit node, broker and time-master,
/// as fast as possible: ticks per second, processor time of each program and bytes per tick. Once
/// with empty states (the barrier alone), once with the states of 18,470 objects, once with empty
/// states at a fixed pace, which gives the cost of time alone. bench/scaling.py fits and
/// extrapolates the results.
int bench_scaling(bool json);
void add_scaling_options(CLI::App& command);

}  // namespace dmise
