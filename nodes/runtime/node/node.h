#pragma once
#include <string>

#include "core/sim/participant.h"
#include "nodes/runtime/process/event.h"
#include "nodes/runtime/protocol/time_split.h"

namespace dmise {

struct NodeOptions {
  std::string master;                      // "tcp://HOST:PORT" of the time-master
  std::string host = "tcp://127.0.0.1:0";  // where this node's own sockets bind
  double join_within_s = 30.0;             // longest wait for the master's first answer
  double stop_within_s = 0.0;              // > 0: a step that is not over so long after the run or
                                           // `stop` ends the process
  std::string keys;                        // directory of keys; empty: plain, loopback alone
  std::string via;        // with keys: the agent whose address `master` is, if it is one's
  std::string name;       // in the run; empty: the participant's
  bool observer = false;  // joins and leaves at any time, holds nobody's time
  int lose_every = 0;     // > 0, for tests: every n-th message published to this node is lost
  Event* stop = nullptr;  // asks the node to leave; see stop_signal()
};

struct NodeResult {
  int exit_code = 0;   // 0, 1, or 2 when the configuration is at fault
  std::string reason;  // of a code other than 0, one line
  Tick done = -1;      // last tick done
  TimeSplit times;
  std::uint64_t refused = 0;  // messages that failed a check
  std::string last_refusal;
  std::uint64_t asked_again = 0;      // requests for messages that were missing
  std::uint64_t asked_for_known = 0;  // of these, for what was known to be published
  std::uint64_t lost = 0;             // by `lose_every`
  std::uint64_t missed = 0;           // messages that nobody kept any more; of an observer
  std::uint64_t incarnation = 1;      // of its name in the run
};

/// Runs a participant as a node of a network: joins at the master, waits until every consumed topic
/// is heard, makes each step when its tick is granted and its inputs are complete, publishes what
/// the step returns, leaves at the end. Truth topics go over a socket of the node's own, all others
/// through the broker. Does not throw and does not print; it logs.
NodeResult run_node(Participant& participant, const NodeOptions& options);

}  // namespace dmise
