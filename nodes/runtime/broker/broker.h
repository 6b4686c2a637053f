#pragma once
#include <string>

#include "nodes/runtime/process/event.h"

namespace dmise {

struct BrokerOptions {
  std::string master;                           // address of the time-master
  std::string publish = "tcp://127.0.0.1:0";    // publishers connect here (XSUB)
  std::string subscribe = "tcp://127.0.0.1:0";  // nodes of the run subscribe here (XPUB)
  std::string observe =
      "tcp://127.0.0.1:0";    // observers subscribe here, with bounded queues (XPUB)
  int observer_queue = 1000;  // messages queued for a slow observer
  double join_within_s = 30.0;
  std::string keys;  // directory of keys; empty: no encryption, loopback only
  Event* stop = nullptr;
};

struct BrokerResult {
  int exit_code = 0;
  std::string reason;
  std::uint64_t messages = 0;  // forwarded
  std::uint64_t refused = 0;   // with keys: sent under another's name
};

/// Forwards messages from publishers to subscribers until the run is over. With keys it refuses
/// messages under a name that is neither the sender's own nor granted to the sender's key (an
/// agent's). Does not throw and does not print; it logs.
BrokerResult run_broker(const BrokerOptions& options);

}  // namespace dmise
