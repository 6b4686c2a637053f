#include "nodes/runtime/inbox.h"

#include <algorithm>
#include <utility>

#include "core/base/error.h"
#include "core/sim/said_once.h"

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

Inbox::Topic* Inbox::find(std::string_view name) {
  const auto found = place_.find(name);
  return found == place_.end() ? nullptr : &topics_[found->second];
}

void Inbox::begin_at(Tick tick, bool catch_up) {
  for (Topic& topic : topics_) {
    topic.complete_to = tick - 1;
    topic.positioned = !catch_up;
  }
}

void Inbox::set_schedule(const std::string& name, Schedule schedule) {
  if (Topic* topic = find(name)) topic->schedule = schedule;
}

void Inbox::restart(const std::string& name) {
  Topic* topic = find(name);
  if (!topic) return;
  topic->next_sequence = 1;
  topic->positioned = false;
  topic->early.clear();
  topic->ready.erase(topic->ready.upper_bound(topic->complete_to), topic->ready.end());
  topic->heard.erase(topic->heard.upper_bound(topic->complete_to), topic->heard.end());
  topic->said.clear();
}

void Inbox::accept(const Received& message) {
  Topic* found = find(message.topic);
  if (!found) return;
  Topic& topic = *found;
  topic.probed = true;
  const Envelope& envelope = message.envelope;
  if (envelope.kind == MessageKind::probe) return;
  if (envelope.kind == MessageKind::position) return position(topic, envelope);
  const std::uint64_t sequence = envelope.sequence;
  if ((topic.positioned && sequence < topic.next_sequence) || topic.early.contains(sequence)) {
    ++duplicates_;
  } else if (!topic.positioned || sequence > topic.next_sequence) {
    if (topic.early.size() < early_limit) topic.early.emplace(sequence, message);
  } else {
    deliver(topic, message);
    deliver_early(topic);
  }
}

void Inbox::position(Topic& topic, const Envelope& envelope) {
  if (topic.positioned && envelope.sequence <= topic.next_sequence) return;
  if (topic.positioned && envelope.tick > topic.complete_to + 1)
    missed_ += envelope.sequence - topic.next_sequence;
  topic.positioned = true;
  topic.next_sequence = envelope.sequence;
  topic.complete_to = std::max(topic.complete_to, envelope.tick - 1);
  while (!topic.early.empty() && topic.early.begin()->first < topic.next_sequence) {
    const Received& message = topic.early.begin()->second;
    if (message.state && said_once(*message.state) && !std::exchange(topic.has_lasting, true))
      topic.lasting.push_back({topic.name, message.envelope.tick, message.state});
    topic.early.erase(topic.early.begin());
  }
  deliver_early(topic);
}

void Inbox::deliver_early(Topic& topic) {
  while (!topic.early.empty() && topic.early.begin()->first == topic.next_sequence) {
    deliver(topic, topic.early.begin()->second);
    topic.early.erase(topic.early.begin());
  }
}

void Inbox::deliver(Topic& topic, const Received& message) {
  const Envelope& envelope = message.envelope;
  ++topic.next_sequence;
  const Tick tick = envelope.tick;
  const bool once = message.state && said_once(*message.state);
  if (once && std::exchange(topic.has_lasting, true)) {
    // Known: a process that follows another says it again.
  } else if (once && tick <= topic.complete_to) {
    topic.lasting.push_back({topic.name, tick, message.state});
  } else if (tick > topic.complete_to && tick < topic.closed_from && message.state) {
    topic.ready[tick].push_back({topic.name, tick, message.state});
  }
  if (tick > topic.complete_to && !once) {
    TopicTally& heard = topic.heard[tick];
    ++heard.messages;
    heard.digest = fold_digest(heard.digest, message.content_digest);
  }
  if (envelope.last_of_tick && tick > topic.complete_to) {
    topic.complete_to = tick;
    compare(topic, tick);
  }
}

void Inbox::published(const TopicTally& tally, Tick tick) {
  Topic* topic = find(tally.topic);
  if (!topic || !topic->positioned) return;
  if (tick <= topic->complete_to && !topic->heard.contains(tick)) return;  // taken
  topic->said[tick] = tally;
  if (tick <= topic->complete_to) compare(*topic, tick);
}

void Inbox::compare(const Topic& topic, Tick tick) const {
  const auto said = topic.said.find(tick);
  const auto heard = topic.heard.find(tick);
  if (said == topic.said.end() || heard == topic.heard.end()) return;
  if (said->second.messages != heard->second.messages ||
      said->second.digest != heard->second.digest)
    throw Error(topic.name + ": what came of tick " + std::to_string(tick) +
                " is not what its publisher says");
}

void Inbox::close(const std::string& name, Tick from_tick) {
  Topic* topic = find(name);
  if (!topic) return;
  topic->closed_from = std::min(topic->closed_from, from_tick);
  topic->ready.erase(topic->ready.lower_bound(topic->closed_from), topic->ready.end());
}

bool Inbox::probed() const {
  return std::all_of(topics_.begin(), topics_.end(), [](const Topic& t) { return t.probed; });
}

bool Inbox::positioned() const {
  return std::all_of(topics_.begin(), topics_.end(), [](const Topic& t) { return t.positioned; });
}

bool Inbox::complete(Tick tick) const {
  return std::all_of(topics_.begin(), topics_.end(),
                     [&](const Topic& topic) { return topic.positioned && topic.covers(tick); });
}

std::vector<Message> Inbox::take(Tick tick) {
  std::vector<Message> messages;
  for (Topic& topic : topics_) {
    std::move(topic.lasting.begin(), topic.lasting.end(), std::back_inserter(messages));
    topic.lasting.clear();
    const auto last = topic.ready.upper_bound(tick);
    for (auto of_tick = topic.ready.begin(); of_tick != last; ++of_tick)
      std::move(of_tick->second.begin(), of_tick->second.end(), std::back_inserter(messages));
    topic.ready.erase(topic.ready.begin(), last);
    topic.heard.erase(topic.heard.begin(), topic.heard.upper_bound(tick));
    topic.said.erase(topic.said.begin(), topic.said.upper_bound(tick));
  }
  return messages;
}

std::size_t Inbox::queued() const {
  std::size_t messages = 0;
  for (const Topic& topic : topics_) {
    messages += topic.lasting.size() + topic.early.size();
    for (const auto& [tick, ready] : topic.ready) messages += ready.size();
  }
  return messages;
}

std::vector<Inbox::Want> Inbox::wanted(Tick tick) const {
  std::vector<Want> wants;
  for (const Topic& topic : topics_) {
    if (topic.positioned && topic.covers(tick)) continue;
    const auto lost = [&](const auto& said) {
      return said.second.last_sequence >= topic.next_sequence;
    };
    // Of a process that follows another: it has said again what is complete here, and need not keep
    // that; what is missing before it is never asked for.
    const bool known =
        !topic.early.empty() && topic.early.begin()->second.envelope.tick <= topic.complete_to;
    wants.push_back(
        {topic.name, topic.next_sequence,
         topic.positioned && !known ? std::nullopt : std::optional(topic.complete_to + 1),
         !topic.early.empty() || std::any_of(topic.said.begin(), topic.said.end(), lost)});
  }
  return wants;
}

}  // namespace dmise
