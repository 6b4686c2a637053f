#pragma once

namespace dmise {

/// Cost of a tick for the time-master, with nodes connected directly and through the agents of
/// hosts: messages and processor time. Prints one line each.
void bench_tick_hosts(bool json);

}  // namespace dmise
