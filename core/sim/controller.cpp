#include "core/sim/controller.h"

#include <algorithm>
#include <map>
#include <set>

#include "core/base/error.h"
#include "core/sim/topic_graph.h"

namespace dmise {
namespace {

NodeTopics topics_of(const Participant& p) {
  NodeTopics node{p.name(), p.produces(), p.consumes(), p.look_back(), p.schedule()};
  for (const auto& topic : node.consumes)
    if (const Tick delay = p.delay(topic); delay > 0) node.delays[topic] = delay;
  return node;
}

/// Orders participants so that producers precede consumers, otherwise as given.
std::vector<std::unique_ptr<Participant>> in_running_order(
    std::vector<std::unique_ptr<Participant>> waiting) {
  std::vector<NodeTopics> nodes;
  for (const auto& p : waiting) nodes.push_back(topics_of(*p));
  if (const auto fault = topic_fault(nodes)) throw Error(*fault);

  std::vector<std::unique_ptr<Participant>> ordered;
  std::set<std::string> available;
  while (!waiting.empty()) {
    const auto next = std::find_if(waiting.begin(), waiting.end(), [&](const auto& p) {
      const auto topics = p->consumes();
      return std::all_of(topics.begin(), topics.end(), [&](const auto& topic) {
        return available.contains(topic) || p->delay(topic) > 0;
      });
    });
    for (auto& topic : (*next)->produces()) available.insert(std::move(topic));
    ordered.push_back(std::move(*next));
    waiting.erase(next);
  }
  return ordered;
}

}  // namespace

SimulationController::SimulationController(std::vector<std::unique_ptr<Participant>> participants)
    : participants_(in_running_order(std::move(participants))) {}

void SimulationController::run(Tick last, const std::function<bool(Tick)>& after_tick, Tick first) {
  std::vector<NodeTopics> nodes;
  for (const auto& p : participants_) nodes.push_back(topics_of(*p));
  const auto history = history_ticks(nodes);
  const auto starts_at = [&](const NodeTopics& node) {
    return std::max<Tick>(0, first - history.at(node.name));
  };
  Tick tick = first;
  for (const NodeTopics& node : nodes) tick = std::min(tick, starts_at(node));

  std::vector<std::map<std::string, std::vector<Message>>> waiting(nodes.size());  // by topic
  for (; tick <= last; ++tick) {
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const NodeTopics& node = nodes[i];
      const Tick start = starts_at(node);
      // What was published up to a tick, of each topic as late as the node hears it.
      const auto take = [&](Tick to) {
        std::vector<Message> inputs;
        for (const auto& topic : node.consumes) {
          auto& messages = waiting[i][topic];
          const Tick delay = node.delay(topic);
          // Drop ticks that no look-back needs.
          const Tick needed = delay > 0 ? 0 : start - node.look_back - (node.schedule.period - 1);
          std::erase_if(messages, [&](const Message& m) {
            return m.tick < needed && !is_retained(*m.state);
          });
          const auto later =
              std::stable_partition(messages.begin(), messages.end(),
                                    [&](const Message& m) { return m.tick <= to - delay; });
          std::move(messages.begin(), later, std::back_inserter(inputs));
          messages.erase(messages.begin(), later);
        }
        return inputs;
      };
      if (tick < start) continue;
      std::vector<Message> outputs;
      if (tick == start && first > 0) outputs = participants_[i]->resume(tick, take(tick - 1));
      if (node.schedule.due(tick))
        for (auto& message : participants_[i]->step(tick, take(tick)))
          outputs.push_back(std::move(message));
      for (const auto& message : outputs)
        for (std::size_t other = 0; other < nodes.size(); ++other)
          if (std::find(nodes[other].consumes.begin(), nodes[other].consumes.end(),
                        message.topic) != nodes[other].consumes.end())
            waiting[other][message.topic].push_back(message);
    }
    if (tick >= first && !after_tick(tick)) return;
  }
}

}  // namespace dmise
