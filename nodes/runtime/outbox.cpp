#include "nodes/runtime/outbox.h"

#include <algorithm>

#include "core/base/error.h"
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
  std::map<std::string, const Message*> last;  // of each topic
  for (const Message& message : messages) {
    if (std::find(topics_.begin(), topics_.end(), message.topic) == topics_.end())
      throw Error(publisher_ + " published on " + message.topic + ", which is not its own");
    if (message.tick != tick || !message.state)
      throw Error(publisher_ + " published a message of tick " + std::to_string(message.tick) +
                  " in tick " + std::to_string(tick));
    last[message.topic] = &message;
  }

  std::vector<SharedFrames> packed;
  std::vector<Kept> kept;
  const auto add = [&](const std::string& topic, bool is_last, Encoded body) {
    const std::uint64_t sequence = ++sequence_[topic];
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
  for (const Message& message : messages)
    add(message.topic, last.at(message.topic) == &message, encode(*message.state));
  for (const std::string& topic : topics_)
    if (!last.contains(topic)) add(topic, true, {});

  const std::lock_guard lock(mutex_);
  for (Kept& entry : kept) kept_[entry.frames->topic].push_back(std::move(entry));
  forget_before(tick - keep_ticks_ + 1);
  return packed;
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

}  // namespace dmise
