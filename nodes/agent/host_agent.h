#pragma once
#include <functional>
#include <string>

#include "nodes/runtime/process/event.h"

namespace dmise {

struct HostAgentOptions {
  std::string name;                        // name that the agent has in the run
  std::string master;                      // address of the time-master
  std::string bind = "tcp://127.0.0.1:0";  // nodes of the host join here; also ipc://PATH
  double join_within_s = 30.0;
  std::string keys;  // directory of keys; empty: no encryption, loopback only
  Event* stop = nullptr;
  std::string announce_file;  // the address is written here when bound
  int announce_fd = -1;       // and here, as one line
  std::function<void(const std::string& address)> on_bound;
};

struct HostAgentResult {
  int exit_code = 0;
  std::string reason;
  std::uint64_t messages_in = 0;   // published elsewhere, each counted once
  std::uint64_t messages_out = 0;  // published on this host
  std::uint64_t refused = 0;       // with keys: published here under another's name
  double cpu_s = 0.0;              // processor time of this process during the run
};

/// Runs the agent of a host, which connects the nodes of the host to the run. To its nodes it is
/// the time-master and the broker; to the run it is one member, which has done a tick when all its
/// nodes have. With keys, its nodes may only use their own names, and the agent needs a key that is
/// granted to speak for them. Does not throw and does not print; it logs.
HostAgentResult run_host_agent(const HostAgentOptions& options);

}  // namespace dmise
