#pragma once

namespace CLI {
class App;
}

namespace dmise {

/// Number of all-sky sensors (`NetworkCase`) that keep up with real time on this machine, without
/// and with detection, the cost of a frame in all processes, and the total memory. Takes minutes,
/// because it runs in real time.
int bench_network(bool json);
void add_network_options(CLI::App& command);

}  // namespace dmise
