#pragma once
#include <string>

#include "nodes/runtime/process/event.h"

namespace dmise {

struct BrokerOptions {
  std::string master;                           // address of the time-master
  std::string publish = "tcp://127.0.0.1:0";    // publishers connect here (XSUB)
  std::string subscribe = "tcp://127.0.0.1:0";  // nodes of the run subscribe here (XPUB)
  std::string observe = "tcp://127.0.0.1:0";  // anybody subscribes here, with bounded queues (XPUB)
  int observer_queue = 1000;                  // messages kept for an observer that does not read
  double join_within_s = 30.0;
  std::string keys;  // directory of keys; empty: plain, loopback alone
  Event* stop = nullptr;
};

struct BrokerResult {
  int exit_code = 0;
  std::string reason;
  std::uint64_t messages = 0;  // passed on
  std::uint64_t refused = 0;   // with keys: in another's name
};

/// Passes messages from publishers to subscribers until the run is over. With keys it looks at who
/// says to have sent them, and refuses what is in the name of another: neither the sender's own,
/// nor one that the key of an agent is granted. Does not throw and does not print; it logs.
BrokerResult run_broker(const BrokerOptions& options);

}  // namespace dmise
