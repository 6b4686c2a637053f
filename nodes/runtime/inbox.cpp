#include "nodes/runtime/inbox.h"

#include <algorithm>

namespace dmise {
namespace {

constexpr std::size_t early_limit =
    4096;  // messages of a topic kept out of turn; others are re-sent

}  // namespace

Inbox::Inbox(std::vector<std::string> topics) {
  for (std::string& name : topics) {
    place_[name] = topics_.size();
    topics_.emplace_back().name = std::move(name);
  }
}

void Inbox::accept(const Received& message) {
  const auto found = place_.find(message.topic);
  if (found == place_.end()) return;
  Topic& topic = topics_[found->second];
  topic.probed = true;
  if (message.envelope.kind == MessageKind::probe) return;
  const std::uint64_t sequence = message.envelope.sequence;
  if (sequence < topic.next_sequence || topic.early.contains(sequence)) {
    ++duplicates_;
  } else if (sequence > topic.next_sequence) {
    if (topic.early.size() < early_limit) topic.early.emplace(sequence, message);
  } else {
    deliver(topic, message);
    while (!topic.early.empty() && topic.early.begin()->first == topic.next_sequence) {
      deliver(topic, topic.early.begin()->second);
      topic.early.erase(topic.early.begin());
    }
  }
}

void Inbox::deliver(Topic& topic, const Received& message) {
  const Envelope& envelope = message.envelope;
  ++topic.next_sequence;
  if (message.state && envelope.tick > topic.complete_to && envelope.tick < topic.closed_from)
    topic.ready[envelope.tick].push_back({topic.name, envelope.tick, message.state});
  if (envelope.last_of_tick) topic.complete_to = std::max(topic.complete_to, envelope.tick);
}

void Inbox::close(const std::string& name, Tick from_tick) {
  const auto found = place_.find(name);
  if (found == place_.end()) return;
  Topic& topic = topics_[found->second];
  topic.closed_from = std::min(topic.closed_from, from_tick);
  topic.ready.erase(topic.ready.lower_bound(topic.closed_from), topic.ready.end());
}

bool Inbox::probed() const {
  return std::all_of(topics_.begin(), topics_.end(), [](const Topic& t) { return t.probed; });
}

bool Inbox::complete(Tick tick) const {
  return std::all_of(topics_.begin(), topics_.end(), [&](const Topic& topic) {
    return tick <= topic.complete_to || tick >= topic.closed_from;
  });
}

std::vector<Message> Inbox::take(Tick tick) {
  std::vector<Message> messages;
  for (Topic& topic : topics_) {
    const auto found = topic.ready.find(tick);
    if (found == topic.ready.end()) continue;
    std::move(found->second.begin(), found->second.end(), std::back_inserter(messages));
    topic.ready.erase(found);
  }
  return messages;
}

std::vector<Inbox::Want> Inbox::wanted(Tick tick) const {
  std::vector<Want> wants;
  for (const Topic& topic : topics_)
    if (tick > topic.complete_to && tick < topic.closed_from)
      wants.push_back({topic.name, topic.next_sequence, !topic.early.empty()});
  return wants;
}

}  // namespace dmise
