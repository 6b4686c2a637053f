#include "nodes/wire/envelope.h"

#include <google/protobuf/stubs/logging.h>

#include "core/base/files/crc32c.h"
#include "dmise/v1/node.pb.h"

namespace dmise {
namespace {

// The seal at the end of the envelope: the tag of field 15, fixed32, then the CRC, little endian.
// Fields may be appended to a serialised message, so the result is an Envelope for any Protocol
// Buffers library.
constexpr char seal_tag = 0x7d;
constexpr std::size_t seal_bytes = 5;

// Unparsable messages are refused and counted here; do not let the library print them too.
[[maybe_unused]] const auto printing = google::protobuf::SetLogHandler(nullptr);

std::uint32_t seal_of(std::string_view topic, std::string_view unsealed, std::string_view payload,
                      std::string_view arrays) {
  std::uint32_t crc = 0;
  for (const auto part : {topic, unsealed, payload, arrays})
    crc = crc32c(part.data(), part.size(), crc);
  return crc;
}

}  // namespace

std::string_view name(Refusal reason) {
  static constexpr std::string_view names[] = {"frames",         "envelope",  "seal",
                                               "schema version", "other run", "topic",
                                               "tick",           "payload",   "value"};
  static_assert(std::size(names) == std::size_t(Refusal::count));
  return names[std::size_t(reason)];
}

Frames seal(std::string topic, const Envelope& envelope, std::string payload, std::string arrays) {
  v1::Envelope wire;
  wire.set_schema_version(wire_schema_version);
  wire.set_run_id(envelope.run_id);
  wire.set_publisher(envelope.publisher);
  wire.set_incarnation(envelope.incarnation);
  wire.set_sequence(envelope.sequence);
  wire.set_kind(static_cast<v1::Kind>(envelope.kind));
  wire.set_tick(envelope.tick);
  wire.set_time_ns(envelope.time.ns);
  wire.set_last_of_tick(envelope.last_of_tick);

  Frames frames{std::move(topic), wire.SerializeAsString(), std::move(payload), std::move(arrays)};
  const std::uint32_t crc = seal_of(frames.topic, frames.envelope, frames.payload, frames.arrays);
  frames.envelope += seal_tag;
  for (int shift = 0; shift < 32; shift += 8) frames.envelope += static_cast<char>(crc >> shift);
  return frames;
}

Envelope open(std::span<const std::string_view> frames) {
  if (frames.size() < 3 || frames.size() > 4)
    throw Refused(Refusal::frames,
                  "a message has 3 or 4 frames, got " + std::to_string(frames.size()));
  const std::string_view topic = frames[0], sealed = frames[1], payload = frames[2];
  const std::string_view arrays = frames.size() == 4 ? frames[3] : std::string_view{};
  if (topic.size() > max_topic_bytes || sealed.size() > max_envelope_bytes ||
      payload.size() > max_payload_bytes || arrays.size() > max_array_bytes)
    throw Refused(Refusal::frames, "a frame is larger than its limit");
  if (frames.size() == 4 && arrays.empty()) throw Refused(Refusal::frames, "an empty fourth frame");
  if (sealed.size() < seal_bytes || sealed[sealed.size() - seal_bytes] != seal_tag)
    throw Refused(Refusal::seal, "no seal");

  const std::string_view unsealed = sealed.substr(0, sealed.size() - seal_bytes);
  std::uint32_t crc = 0;
  for (std::size_t i = 0; i < 4; ++i)
    crc |= std::uint32_t(static_cast<unsigned char>(sealed[sealed.size() - 4 + i])) << (8 * i);
  if (crc != seal_of(topic, unsealed, payload, arrays)) throw Refused(Refusal::seal, "broken seal");

  v1::Envelope wire;
  if (!wire.ParseFromArray(unsealed.data(), static_cast<int>(unsealed.size())))
    throw Refused(Refusal::envelope, "not an envelope");
  if (wire.schema_version() != wire_schema_version)
    throw Refused(Refusal::schema_version, "schema version " +
                                               std::to_string(wire.schema_version()) + ", here " +
                                               std::to_string(wire_schema_version));
  if ((wire.kind() < v1::KIND_PROBE || wire.kind() > v1::KIND_TASK_SET) &&
      wire.kind() != v1::KIND_POSITION)
    throw Refused(Refusal::envelope, "unknown kind " + std::to_string(wire.kind()));
  return {.run_id = wire.run_id(),
          .publisher = wire.publisher(),
          .incarnation = wire.incarnation(),
          .sequence = wire.sequence(),
          .kind = static_cast<MessageKind>(wire.kind()),
          .tick = wire.tick(),
          .time = {wire.time_ns()},
          .last_of_tick = wire.last_of_tick()};
}

}  // namespace dmise
