#include "nodes/wire/receiver.h"

#include <numeric>

#include "nodes/wire/content_digest.h"
#include "nodes/wire/state_codec.h"
#include "nodes/wire/state_rules.h"

namespace dmise {

void Receiver::allow(const std::string& topic, const std::string& publisher,
                     std::uint64_t incarnation) {
  sources_[topic] = {publisher, incarnation};
}

std::optional<Received> Receiver::receive(std::span<const std::string_view> frames) {
  try {
    return accept(frames);
  } catch (const Refused& refusal) {
    ++refused_[std::size_t(refusal.reason)];
    last_refusal_ = std::string(name(refusal.reason)) + ": " + refusal.what();
    return std::nullopt;
  }
}

std::uint64_t Receiver::refused() const {
  return std::accumulate(refused_.begin(), refused_.end(), std::uint64_t(0));
}

Received Receiver::accept(std::span<const std::string_view> frames) const {
  Received message{{}, open(frames), nullptr, 0};
  const Envelope& envelope = message.envelope;
  if (envelope.run_id != run_.run_id) throw Refused(Refusal::run, "message of another run");
  const auto source = sources_.find(frames[0]);
  if (source == sources_.end() || source->second.publisher != envelope.publisher ||
      source->second.incarnation != envelope.incarnation)
    throw Refused(Refusal::topic, envelope.publisher + " does not publish there");
  message.topic = source->first;

  const std::string_view payload = frames[2];
  const std::string_view arrays = frames.size() == 4 ? frames[3] : std::string_view{};
  const bool stateless = envelope.kind == MessageKind::probe ||
                         envelope.kind == MessageKind::watermark ||
                         envelope.kind == MessageKind::position;
  if (stateless && !(payload.empty() && arrays.empty()))
    throw Refused(Refusal::payload, "a message without a state has content");
  if (envelope.kind == MessageKind::probe) return message;

  if (envelope.tick < 0 || envelope.tick > run_.last_tick ||
      envelope.time != run_.time_of(envelope.tick))
    throw Refused(Refusal::tick, "tick " + std::to_string(envelope.tick) + " at " +
                                     std::to_string(envelope.time.ns) + " ns");
  if (envelope.sequence == 0) throw Refused(Refusal::envelope, "sequence counts from 1");
  message.content_digest = content_digest(envelope.kind, payload, arrays);
  if (!stateless) {
    auto state = std::make_shared<const State>(decode(envelope.kind, payload, arrays));
    check_place(message.topic, envelope, *state);
    message.state = std::move(state);
  }
  return message;
}

}  // namespace dmise
