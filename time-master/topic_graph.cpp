#include "time-master/topic_graph.h"

#include <map>

namespace dmise {
namespace {

enum class Visit { none, open, closed };

// Depth first along "consumes from"; meeting an open node again closes a loop.
struct LoopSearch {
  const std::vector<NodeTopics>& nodes;
  const std::map<std::string, std::size_t>& producer_of;
  std::vector<Visit> visits;
  std::vector<std::size_t> path;

  std::optional<std::string> from(std::size_t node) {
    if (visits[node] == Visit::closed) return std::nullopt;
    if (visits[node] == Visit::open) {
      std::string loop;
      bool inside = false;
      for (const std::size_t step : path) {
        inside = inside || step == node;
        if (inside) loop += nodes[step].name + " -> ";
      }
      return "nodes wait for each other within a tick: " + loop + nodes[node].name;
    }
    visits[node] = Visit::open;
    path.push_back(node);
    for (const std::string& topic : nodes[node].consumes)
      if (auto fault = from(producer_of.at(topic))) return fault;
    path.pop_back();
    visits[node] = Visit::closed;
    return std::nullopt;
  }
};

}  // namespace

std::optional<std::string> topic_fault(const std::vector<NodeTopics>& nodes) {
  std::map<std::string, std::size_t> producer_of;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (const std::string& topic : nodes[i].produces) {
      const auto [other, fresh] = producer_of.emplace(topic, i);
      if (!fresh)
        return topic + " has two producers: " + nodes[other->second].name + " and " + nodes[i].name;
    }
  for (const NodeTopics& node : nodes)
    for (const std::string& topic : node.consumes)
      if (!producer_of.contains(topic))
        return node.name + " needs " + topic + ", which nobody produces";
  LoopSearch search{nodes, producer_of, std::vector<Visit>(nodes.size(), Visit::none), {}};
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (auto fault = search.from(i)) return fault;
  return std::nullopt;
}

}  // namespace dmise
