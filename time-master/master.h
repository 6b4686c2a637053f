#pragma once
#include <functional>
#include <string>

#include "nodes/runtime/process/event.h"
#include "nodes/runtime/security/security.h"
#include "time-master/coordinator.h"
#include "time-master/master_result.h"

namespace dmise {

struct MasterOptions {
  std::string address = "tcp://127.0.0.1:0";  // where all processes connect
  CoordinatorOptions run;  // `expected`: nodes that the clock waits for, without the broker
  bool with_broker = true;
  SimTime tick_length{1'000'000'000};
  std::string start_utc;        // when tick 0 is (ISO 8601), for status; may be empty
  std::string scenario_digest;  // for those who join; may be empty
  std::string keys;             // directory of keys; empty: no encryption, loopback only
  Event* stop = nullptr;
  std::string announce_file;  // the address is written here when bound
  int announce_fd = -1;       // and here, as one line
  std::function<void(const std::string& address)> on_bound;
};

/// Runs the clock of one run until every tick is done or the run fails. Throws `ConfigError` for
/// invalid options and `Error` if the address cannot be bound.
MasterResult run_master(const MasterOptions& options);

}  // namespace dmise
