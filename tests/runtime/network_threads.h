#pragma once
#include <future>
#include <string>
#include <vector>

#include "nodes/runtime/broker/broker.h"
#include "nodes/runtime/node/node.h"
#include "nodes/runtime/observability/status.h"
#include "time-master/master.h"

// A network in one process: master, broker and nodes as threads, over real sockets.
namespace dmise::test {

/// A master in a thread; `address` once it is bound.
struct MasterThread {
  explicit MasterThread(MasterOptions options) {
    std::promise<std::string> bound;
    auto address_future = bound.get_future();
    options.on_bound = [&](const std::string& where) { bound.set_value(where); };
    options.stop = &stop;
    result = std::async(std::launch::async, [options] { return run_master(options); });
    address = address_future.get();
  }
  ~MasterThread() { stop.set(); }

  Event stop;
  std::string address;
  std::future<MasterResult> result;
};

inline std::future<NodeResult> start(Participant& participant, const NodeOptions& options) {
  return std::async(std::launch::async,
                    [&participant, options] { return run_node(participant, options); });
}

inline std::future<NodeResult> start(Participant& participant, const std::string& master,
                                     Event* stop = nullptr) {
  return start(participant, NodeOptions{.master = master, .stop = stop});
}

inline std::future<BrokerResult> start_broker(const std::string& master,
                                              int observer_queue = 1000) {
  return std::async(std::launch::async, [master, observer_queue] {
    return run_broker({.master = master, .observer_queue = observer_queue});
  });
}

inline MasterOptions run_of(std::vector<std::string> expected, Tick last_tick, int window = 1) {
  MasterOptions options;
  options.run.expected = std::move(expected);
  options.run.last_tick = last_tick;
  options.run.window_ticks = window;
  return options;
}

}  // namespace dmise::test
