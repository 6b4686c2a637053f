#include "core/sim/controller.h"

#include <algorithm>
#include <map>
#include <set>

#include "core/base/error.h"

namespace dmise {
namespace {

/// Participants so that producers come before consumers, otherwise in the order given.
std::vector<std::unique_ptr<Participant>> in_running_order(
    std::vector<std::unique_ptr<Participant>> waiting) {
  std::map<std::string, std::string> producer;
  for (const auto& p : waiting)
    for (const auto& topic : p->produces())
      if (!producer.emplace(topic, p->name()).second)
        throw Error(p->name() + " and " + producer[topic] + " both produce " + topic);
  for (const auto& p : waiting)
    for (const auto& topic : p->consumes())
      if (!producer.contains(topic)) throw Error(p->name() + ": nobody produces " + topic);

  std::vector<std::unique_ptr<Participant>> ordered;
  std::set<std::string> available;
  while (!waiting.empty()) {
    const auto next = std::find_if(waiting.begin(), waiting.end(), [&](const auto& p) {
      const auto topics = p->consumes();
      return std::all_of(topics.begin(), topics.end(),
                         [&](const auto& topic) { return available.contains(topic); });
    });
    if (next == waiting.end())
      throw Error(waiting.front()->name() + " waits for a topic that waits for it");
    for (auto& topic : (*next)->produces()) available.insert(std::move(topic));
    ordered.push_back(std::move(*next));
    waiting.erase(next);
  }
  return ordered;
}

}  // namespace

SimulationController::SimulationController(std::vector<std::unique_ptr<Participant>> participants)
    : participants_(in_running_order(std::move(participants))) {}

void SimulationController::run(Tick last, const std::function<bool(Tick)>& after_tick) {
  for (Tick tick = 0; tick <= last; ++tick) {
    std::map<std::string, std::vector<Message>> published;
    for (const auto& participant : participants_) {
      std::vector<Message> inputs;
      for (const auto& topic : participant->consumes())
        inputs.insert(inputs.end(), published[topic].begin(), published[topic].end());
      for (auto& message : participant->step(tick, inputs))
        published[message.topic].push_back(std::move(message));
    }
    if (!after_tick(tick)) return;
  }
}

}  // namespace dmise
