#pragma once

namespace dmise {

/// What a tick costs the time-master, with all nodes its own and with them behind the agents of
/// hosts: messages and processor time. Prints a line each.
void bench_tick_hosts(bool json);

}  // namespace dmise
