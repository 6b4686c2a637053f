#pragma once
#include <optional>
#include <string>
#include <vector>

namespace dmise {

/// What a node publishes and needs.
struct NodeTopics {
  std::string name;
  std::vector<std::string> produces;
  std::vector<std::string> consumes;
};

/// Why these nodes can't run together: a topic that nobody produces, one with two producers, or
/// nodes that would wait for each other within a tick. Empty when they can.
std::optional<std::string> topic_fault(const std::vector<NodeTopics>& nodes);

}  // namespace dmise
