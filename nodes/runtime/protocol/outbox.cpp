#include "nodes/runtime/protocol/outbox.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/sim/message.h"
#include "nodes/wire/content_digest.h"
#include "nodes/wire/state_codec.h"

namespace dmise {

Outbox::Outbox(RunFacts run, std::string publisher, std::uint64_t incarnation,
               std::vector<std::string> topics, Tick keep_ticks)
    : run_(run),
      publisher_(std::move(publisher)),
      incarnation_(incarnation),
      topics_(std::move(topics)),
      keep_ticks_(keep_ticks) {}

std::vector<SharedFrames> Outbox::probes() const {
  std::vector<SharedFrames> frames;
  for (const std::string& topic : topics_)
    frames.push_back(std::make_shared<const Frames>(seal(topic, {.run_id = run_.run_id,
                                                                 .publisher = publisher_,
                                                                 .incarnation = incarnation_,
                                                                 .kind = MessageKind::probe})));
  return frames;
}

std::vector<SharedFrames> Outbox::pack(Tick tick, const std::vector<Message>& messages) {
  std::map<std::string, const Message*> last;  // the last message by topic
  for (const Message& message : messages) {
    if (std::find(topics_.begin(), topics_.end(), message.topic) == topics_.end())
      throw Error(publisher_ + " published on " + message.topic + ", which is not its own");
    if (message.tick != tick || !message.state)
      throw Error(publisher_ + " published a message of tick " + std::to_string(message.tick) +
                  " in tick " + std::to_string(tick));
    if (!is_due(message.topic, tick))
      throw Error(publisher_ + " published on " + message.topic + " in tick " +
                  std::to_string(tick) + ", which is not in its schedule");
    last[message.topic] = &message;
  }

  std::vector<SharedFrames> packed;
  std::vector<Kept> kept;
  std::map<std::string, SharedFrames> lasting;
  std::map<std::string, TopicTally> tallies;
  const auto add = [&](const std::string& topic, bool is_last, bool once, Encoded body) {
    const std::uint64_t sequence = ++sequence_[topic];
    TopicTally& tally = tallies[topic];
    if (!once) ++tally.messages;
    tally.last_sequence = sequence;
    if (!once)
      tally.digest =
          fold_digest(tally.digest, content_digest(body.kind, body.payload, body.arrays));
    const Envelope envelope{.run_id = run_.run_id,
                            .publisher = publisher_,
                            .incarnation = incarnation_,
                            .sequence = sequence,
                            .kind = body.kind,
                            .tick = tick,
                            .time = run_.time_of(tick),
                            .last_of_tick = is_last};
    packed.push_back(std::make_shared<const Frames>(
        seal(topic, envelope, std::move(body.payload), std::move(body.arrays))));
    kept.push_back({sequence, tick, packed.back()});
  };
  for (const Message& message : messages) {
    add(message.topic, last.at(message.topic) == &message, is_retained(*message.state),
        encode(*message.state));
    if (is_retained(*message.state)) lasting[message.topic] = packed.back();
  }
  for (const std::string& topic : topics_)
    if (!last.contains(topic) && is_due(topic, tick)) add(topic, true, false, {});

  tally_ = {tick, {}};
  for (const std::string& topic : topics_) {
    const auto tally = tallies.find(topic);
    if (tally == tallies.end()) continue;
    tally_.topics.push_back(tally->second);
    tally_.topics.back().topic = topic;
  }

  const std::lock_guard lock(mutex_);
  for (auto& [topic, frames] : lasting) lasting_[topic] = frames;
  for (const auto& [topic, sequence] : sequence_) next_[topic] = sequence + 1;
  next_tick_ = tick + 1;
  for (Kept& entry : kept) kept_[entry.frames->topic].push_back(std::move(entry));
  forget_before(tick - keep_ticks_ + 1);
  return packed;
}

bool Outbox::is_due(const std::string& topic, Tick tick) const {
  const auto own = schedules_.find(topic);
  return own == schedules_.end() || own->second.due(tick);
}

void Outbox::forget_before(Tick tick) {
  for (auto& [topic, entries] : kept_)
    while (!entries.empty() && entries.front().tick < tick) entries.pop_front();
}

std::vector<SharedFrames> Outbox::since(const std::string& topic, std::uint64_t sequence) const {
  std::vector<SharedFrames> frames;
  const std::lock_guard lock(mutex_);
  const auto found = kept_.find(topic);
  if (found == kept_.end()) return frames;
  for (const Kept& entry : found->second)
    if (entry.sequence >= sequence) frames.push_back(entry.frames);
  return frames;
}

std::vector<SharedFrames> Outbox::catch_up(const std::string& topic, Tick from_tick) const {
  std::vector<SharedFrames> frames;
  if (std::find(topics_.begin(), topics_.end(), topic) == topics_.end()) return frames;
  const std::lock_guard lock(mutex_);
  if (const auto once = lasting_.find(topic); once != lasting_.end())
    frames.push_back(once->second);
  const auto next = next_.find(topic);
  Envelope position{.run_id = run_.run_id,
                    .publisher = publisher_,
                    .incarnation = incarnation_,
                    .sequence = next == next_.end() ? 1 : next->second,
                    .kind = MessageKind::position,
                    .tick = std::min(std::max(from_tick, next_tick_), run_.last_tick)};
  std::vector<SharedFrames> messages;
  if (const auto kept = kept_.find(topic); kept != kept_.end())
    for (const Kept& entry : kept->second) {
      if (entry.tick < from_tick) continue;
      if (messages.empty()) position.sequence = entry.sequence, position.tick = entry.tick;
      messages.push_back(entry.frames);
    }
  if (from_tick < position.tick && !messages.empty() && next_tick_ - keep_ticks_ <= from_tick)
    position.tick = from_tick;  // complete: there was no step in between
  position.time = run_.time_of(position.tick);
  frames.push_back(std::make_shared<const Frames>(seal(topic, position)));
  frames.insert(frames.end(), messages.begin(), messages.end());
  return frames;
}

}  // namespace dmise
