#pragma once
#include <string>

#include "core/sim/participant.h"
#include "nodes/runtime/process/event.h"
#include "nodes/runtime/protocol/kept_frames.h"
#include "nodes/runtime/protocol/time_split.h"

namespace dmise {

struct NodeOptions {
  std::string master;                      // "tcp://HOST:PORT" of the time-master
  std::string host = "tcp://127.0.0.1:0";  // where this node's own sockets bind
  double join_within_s = 30.0;             // longest wait for the master's first answer
  double stop_within_s = 0.0;              // > 0: ends the process if a step lasts longer than this
                                           // after the end of the run or `stop`
  std::string keys;                        // directory of keys; empty: no encryption, loopback only
  std::string via;               // with keys: name of the agent, if `master` is an agent's address
  std::string name;              // in the run; default: the participant's
  bool observer = false;         // joins and leaves at any time; the clock does not wait for it
  int lose_every = 0;            // > 0, for tests: drops every n-th message for this node
  KeptFrames* frames = nullptr;  // served to readers; null: none
  Event* stop = nullptr;         // makes the node leave; see stop_signal()
};

struct NodeResult {
  int exit_code = 0;   // 0, 1, or 2 for an invalid configuration
  std::string reason;  // why it is not 0, one line
  Tick done = -1;      // last tick done
  TimeSplit times;
  std::uint64_t refused = 0;  // messages that failed a check
  std::string last_refusal;
  std::uint64_t resend_requests = 0;        // requests for missing messages
  std::uint64_t resend_requests_known = 0;  // requests for messages known to be published
  std::uint64_t lost = 0;                   // dropped by `lose_every`
  std::uint64_t missed = 0;                 // messages no longer available; of an observer
};

/// Runs a participant as a node of a network: joins at the master, waits until every consumed topic
/// is connected, performs each step when its tick is granted and its inputs are complete, publishes
/// the result, leaves at the end. Truth topics use a socket of the node's own, all others the
/// broker. Does not throw and does not print; it logs.
NodeResult run_node(Participant& participant, const NodeOptions& options);

}  // namespace dmise
