#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "core/base/sim_time.h"
#include "nodes/wire/refusal.h"

namespace dmise {

inline constexpr std::uint32_t wire_schema_version = 1;
inline constexpr std::size_t max_topic_bytes = 256;
inline constexpr std::size_t max_envelope_bytes = 1024;
inline constexpr std::size_t max_payload_bytes = std::size_t(16) << 20;
inline constexpr std::size_t max_array_bytes = std::size_t(256) << 20;

/// Kind of a message; values are those of Kind in proto/dmise/v1/node.proto.
enum class MessageKind : std::uint8_t {
  probe = 1,
  watermark = 2,
  object_roster = 3,
  object_states = 4,
  environment_state = 5,
  frame_report = 6,
  detection_set = 7,
  truth_set = 8,
  site_state = 9,
  track_set = 10,
  task_set = 11,
  position = 100,  // sequence position of a topic, in an answer to a resend request
};

struct Envelope {
  std::uint64_t run_id = 0;
  std::string publisher;
  std::uint64_t incarnation = 1;
  std::uint64_t sequence = 0;  // the publisher's messages on this topic, from 1; a probe has 0
  MessageKind kind = MessageKind::probe;
  Tick tick = 0;
  SimTime time;
  bool last_of_tick = false;  // the topic is complete for this tick and all before
};

/// One message as its frames. `arrays` is sent as a fourth frame unless it is empty.
struct Frames {
  std::string topic;
  std::string envelope;
  std::string payload;
  std::string arrays;

  std::size_t bytes() const {
    return topic.size() + envelope.size() + payload.size() + arrays.size();
  }
};

/// Assembles topic, envelope and content and seals them with their CRC-32C.
Frames seal(std::string topic, const Envelope& envelope, std::string payload = {},
            std::string arrays = {});

/// Returns the envelope of three or four frames with a valid seal. Throws `Refused` otherwise.
Envelope open(std::span<const std::string_view> frames);

}  // namespace dmise
