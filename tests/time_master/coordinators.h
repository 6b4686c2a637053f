#pragma once
#include <string>
#include <vector>

#include "time-master/coordinator.h"

// Runs for tests of the state machine.
namespace dmise::test {

inline Coordinator::Request node(const std::string& name, std::vector<std::string> produces = {},
                                 std::vector<std::string> consumes = {}) {
  return {.node = {name, std::move(produces), std::move(consumes)}};
}

inline CoordinatorOptions options(std::vector<std::string> expected, Tick last_tick = 9,
                                  int window = 1) {
  CoordinatorOptions o;
  o.expected = std::move(expected);
  o.last_tick = last_tick;
  o.window_ticks = window;
  return o;
}

inline Coordinator started(const CoordinatorOptions& o) {
  Coordinator master(o);
  for (const std::string& name : o.expected) master.join(node(name));
  for (const std::string& name : o.expected) master.ready(name);
  return master;
}

}  // namespace dmise::test
