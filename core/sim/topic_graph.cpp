#include "core/sim/topic_graph.h"

#include <algorithm>
#include <functional>

namespace dmise {
namespace {

enum class Visit { none, open, closed };

// Depth-first search along "consumes from"; an open node closes a loop.
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
      if (nodes[node].delay(topic) == 0)
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

std::map<std::string, Tick> history_ticks(const std::vector<NodeTopics>& nodes) {
  std::map<std::string, std::vector<const NodeTopics*>> consumers;
  for (const NodeTopics& node : nodes)
    for (const std::string& topic : node.consumes) consumers[topic].push_back(&node);
  std::map<std::string, Tick> history;
  const std::function<Tick(const NodeTopics&)> of = [&](const NodeTopics& node) {
    if (const auto known = history.find(node.name); known != history.end()) return known->second;
    Tick ticks = 0;
    for (const std::string& topic : node.produces)
      for (const NodeTopics* other : consumers[topic]) {
        const Tick delay = other->delay(topic);
        const Tick needed = delay > 0 ? delay : other->look_back + of(*other);
        // A node with period n consumes the inputs of the n - 1 ticks before as well.
        ticks = std::max(ticks, needed + other->schedule.period - 1);
      }
    return history[node.name] = ticks;
  };
  for (const NodeTopics& node : nodes) of(node);
  return history;
}

}  // namespace dmise
