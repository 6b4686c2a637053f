#include "nodes/runtime/protocol/inbox.h"

#include <algorithm>
#include <utility>

#include "core/base/error.h"
#include "core/sim/message.h"

namespace dmise {
namespace {

constexpr std::size_t waiting_limit = 4096;  // messages of a topic; others are requested again

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

void Inbox::set_delay(const std::string& name, Tick delay, Tick reaches_back) {
  Topic* topic = find(name);
  if (!topic) return;
  topic->delay = delay;
  topic->reaches_back = reaches_back;
}

void Inbox::begin_at(Tick tick, Tick resumes_at, bool catch_up) {
  for (Topic& topic : topics_) {
    topic.begins_at = topic.delay > 0 ? std::max<Tick>(0, resumes_at - topic.reaches_back) : tick;
    topic.complete_to = topic.begins_at - 1;
    topic.positioned = !catch_up;
  }
}

Tick Inbox::begins_at(const std::string& name) const {
  const auto found = place_.find(name);
  return found == place_.end() ? 0 : topics_[found->second].begins_at;
}

void Inbox::set_schedule(const std::string& name, Schedule schedule) {
  if (Topic* topic = find(name)) topic->schedule = schedule;
}

void Inbox::restart(const std::string& name) {
  Topic* topic = find(name);
  if (!topic) return;
  topic->next_sequence = 1;
  topic->positioned = false;
  topic->waiting.clear();
  topic->doubted = false;
  topic->ready.erase(topic->ready.upper_bound(topic->complete_to), topic->ready.end());
  topic->heard.erase(topic->heard.upper_bound(topic->complete_to), topic->heard.end());
  topic->manifests.clear();
}

void Inbox::accept(const Received& message, Way way) {
  Topic* found = find(message.topic);
  if (!found) return;
  Topic& topic = *found;
  topic.probed = true;
  const Envelope& envelope = message.envelope;
  if (envelope.kind == MessageKind::probe) return;
  if (envelope.kind == MessageKind::position) {
    if (way == Way::answer) position(topic, envelope);
    return;
  }
  const bool sure = way != Way::broker;
  if (topic.doubted && !sure) return;
  const std::uint64_t sequence = envelope.sequence;
  if (topic.positioned && sequence < topic.next_sequence) {
    ++duplicates_;
    return;
  }
  if (topic.positioned && sequence - topic.next_sequence >= waiting_limit) return;
  const auto [entry, fresh] = topic.waiting.try_emplace(sequence);
  if (!fresh) ++duplicates_;
  if (!fresh && sure && !entry->second.sure && !topic.manifests.contains(envelope.tick))
    topic.unannounced = true;
  if (fresh || (sure && !entry->second.sure)) entry->second = {message, sure};
  if (topic.waiting.size() > waiting_limit) topic.waiting.erase(std::prev(topic.waiting.end()));
  settle(topic);
}

void Inbox::position(Topic& topic, const Envelope& envelope) {
  if (topic.positioned && !topic.doubted && envelope.sequence <= topic.next_sequence) return;
  if (topic.positioned && envelope.tick > topic.complete_to + 1 &&
      envelope.sequence > topic.next_sequence)
    missed_ += envelope.sequence - topic.next_sequence;
  topic.positioned = true;
  topic.next_sequence = envelope.sequence;
  topic.complete_to = std::max(topic.complete_to, envelope.tick - 1);
  while (!topic.waiting.empty() && topic.waiting.begin()->first < topic.next_sequence) {
    keep_lasting(topic, topic.waiting.begin()->second.message);
    topic.waiting.erase(topic.waiting.begin());
  }
  settle(topic);
}

/// Retained messages count whatever their tick.
void Inbox::keep_lasting(Topic& topic, const Received& message) {
  if (message.state && is_retained(*message.state) && !std::exchange(topic.has_lasting, true))
    topic.lasting.push_back({topic.name, message.envelope.tick, message.state});
}

/// Delivers the next messages tick by tick, if they are trusted or match the manifest.
void Inbox::settle(Topic& topic) {
  if (!topic.positioned) return;
  for (;;) {
    auto next = topic.waiting.find(topic.next_sequence);
    if (next != topic.waiting.end() && next->second.sure) {
      deliver(topic, next->second.message);
      topic.waiting.erase(next);
      continue;
    }
    std::uint64_t sequence = topic.next_sequence;
    while (next != topic.waiting.end() && next->first == sequence &&
           !next->second.message.envelope.last_of_tick)
      ++next, ++sequence;
    const bool whole = next != topic.waiting.end() && next->first == sequence;
    if (contradicts(topic)) return doubt(topic);
    if (!whole || !settle_group(topic, std::next(next))) return;
  }
}

/// Whether the manifest of the next tick says that a skipped message was its last.
bool Inbox::contradicts(const Topic& topic) const {
  const auto manifest = topic.manifests.find(topic.schedule.next_after(topic.complete_to));
  return manifest != topic.manifests.end() && manifest->second.last_sequence < topic.next_sequence;
}

/// Accepts the waiting messages up to `end` if they complete a tick. False if they cannot count, or
/// not yet.
bool Inbox::settle_group(Topic& topic, std::map<std::uint64_t, Waiting>::iterator end) {
  const auto last = std::prev(end);
  const Tick tick = last->second.message.envelope.tick;
  TopicTally tally = {};
  if (const auto heard = topic.heard.find(tick); heard != topic.heard.end()) tally = heard->second;
  bool one_tick = true;
  for (auto entry = topic.waiting.begin(); entry != end; ++entry) {
    const Received& message = entry->second.message;
    one_tick = one_tick && message.envelope.tick == tick;
    if (message.state && is_retained(*message.state)) continue;
    ++tally.messages;
    tally.digest = fold_digest(tally.digest, message.content_digest);
  }
  const auto manifest = topic.manifests.find(tick);
  // A process that replaces another repeats what counts already.
  const bool known = one_tick && tick <= topic.complete_to;
  const bool next = tick == topic.schedule.next_after(topic.complete_to);
  const bool agrees =
      manifest != topic.manifests.end() && manifest->second.messages == tally.messages &&
      manifest->second.digest == tally.digest && manifest->second.last_sequence == last->first;
  if (!known && one_tick && next && manifest == topic.manifests.end())
    return false;  // no manifest yet
  if (!known && !(one_tick && next && agrees)) {
    // Only the manifest of the next tick can show which message is wrong.
    if (topic.manifests.contains(topic.schedule.next_after(topic.complete_to))) doubt(topic);
    return false;
  }
  topic.unannounced = topic.unannounced && known;
  for (auto entry = topic.waiting.begin(); entry != end; entry = topic.waiting.erase(entry))
    deliver(topic, entry->second.message);
  return true;
}

void Inbox::doubt(Topic& topic) {
  topic.doubted = true;
  forged_ += std::erase_if(topic.waiting, [](const auto& entry) { return !entry.second.sure; });
}

void Inbox::deliver(Topic& topic, const Received& message) {
  const Envelope& envelope = message.envelope;
  ++topic.next_sequence;
  const Tick tick = envelope.tick;
  const bool once = message.state && is_retained(*message.state);
  if (once && std::exchange(topic.has_lasting, true)) {
    // Known: repeated by a process that replaces another.
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
  if (!topic) return;
  if (tick <= topic->complete_to && !topic->heard.contains(tick)) return;  // already taken
  topic->manifests[tick] = tally;
  if (tick <= topic->complete_to)
    compare(*topic, tick);
  else
    settle(*topic);
}

void Inbox::compare(const Topic& topic, Tick tick) const {
  const auto manifest = topic.manifests.find(tick);
  const auto heard = topic.heard.find(tick);
  if (manifest == topic.manifests.end() || heard == topic.heard.end()) return;
  if (manifest->second.messages != heard->second.messages ||
      manifest->second.digest != heard->second.digest)
    throw Error(topic.name + ": the content of tick " + std::to_string(tick) +
                " differs from its publisher's manifest");
}

void Inbox::close(const std::string& name, Tick from_tick) {
  Topic* topic = find(name);
  if (!topic) return;
  topic->closed_from = std::min(topic->closed_from, from_tick);
  topic->ready.erase(topic->ready.lower_bound(topic->closed_from), topic->ready.end());
}

bool Inbox::probed() const {
  return std::all_of(topics_.begin(), topics_.end(),
                     [](const Topic& t) { return t.probed || t.closed_from != INT64_MAX; });
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
    const Tick to = tick - topic.delay;
    const auto last = topic.ready.upper_bound(to);
    for (auto of_tick = topic.ready.begin(); of_tick != last; ++of_tick)
      std::move(of_tick->second.begin(), of_tick->second.end(), std::back_inserter(messages));
    topic.ready.erase(topic.ready.begin(), last);
    topic.heard.erase(topic.heard.begin(), topic.heard.upper_bound(to));
    topic.manifests.erase(topic.manifests.begin(), topic.manifests.upper_bound(to));
  }
  return messages;
}

std::size_t Inbox::queued() const {
  std::size_t messages = 0;
  for (const Topic& topic : topics_) {
    messages += topic.lasting.size() + topic.waiting.size();
    for (const auto& [tick, ready] : topic.ready) messages += ready.size();
  }
  return messages;
}

/// Whether something is known to be published and missing, or must be requested because the
/// manifest of what is here comes only then.
bool Inbox::lacks_published(const Topic& topic) {
  if (topic.doubted) return topic.manifests.upper_bound(topic.complete_to) != topic.manifests.end();
  if (topic.unannounced && !topic.waiting.empty()) return true;
  std::uint64_t next = topic.next_sequence;
  for (const auto& [sequence, waiting] : topic.waiting)
    if (sequence != next++) return true;
  return std::any_of(topic.manifests.begin(), topic.manifests.end(),
                     [&](const auto& manifest) { return manifest.second.last_sequence >= next; });
}

std::vector<Inbox::Want> Inbox::wanted(Tick tick) const {
  std::vector<Want> wants;
  for (const Topic& topic : topics_) {
    if (topic.positioned && topic.covers(tick)) continue;
    // A replacing process has repeated what is complete here and need not keep it; what is missing
    // before it is never requested.
    const bool known = !topic.waiting.empty() &&
                       topic.waiting.begin()->first > topic.next_sequence &&
                       topic.waiting.begin()->second.message.envelope.tick <= topic.complete_to;
    const bool by_tick = !topic.positioned || known || topic.doubted;
    wants.push_back({topic.name, topic.next_sequence,
                     by_tick ? std::optional(topic.complete_to + 1) : std::nullopt,
                     lacks_published(topic)});
  }
  return wants;
}

}  // namespace dmise
