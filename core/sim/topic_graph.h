#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/sim/schedule.h"

namespace dmise {

/// What a node publishes and needs.
struct NodeTopics {
  std::string name;
  std::vector<std::string> produces;
  std::vector<std::string> consumes;
  Tick look_back = 0;  // ticks before the one it resumes at whose inputs it needs
  Schedule schedule;
};

/// Why these nodes can't run together: a topic that nobody produces, one with two producers, or
/// nodes that would wait for each other within a tick. Empty when they can.
std::optional<std::string> topic_fault(const std::vector<NodeTopics>& nodes);

/// For nodes that can run together, by name: how many ticks before tick k a node must have
/// published for all who depend on it to be able to resume at k. A consumer needs its look-back,
/// and what it must have published itself for its own consumers: the longest sum along the graph.
std::map<std::string, Tick> history_ticks(const std::vector<NodeTopics>& nodes);

}  // namespace dmise
