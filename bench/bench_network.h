#pragma once

namespace CLI {
class App;
}

namespace dmise {

/// How many all-sky sensors (`NetworkCase`) keep up with real time on this machine, without and
/// with detection, what a frame costs all processes together, and the memory of all. Takes minutes:
/// it waits for real time.
int bench_network(bool json);
void add_network_options(CLI::App& command);

}  // namespace dmise
