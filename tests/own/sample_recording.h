#pragma once
#include <google/protobuf/unknown_field_set.h>
#include <zstd.h>

#include <cstdint>
#include <string>
#include <string_view>

#include "core/config/scenario.h"
#include "dmise/v1/node.pb.h"
#include "dmise/v1/time.pb.h"
#include "nodes/wire/state_codec.h"

// Records of MCAP files (mcap.dev/spec), and a recording of three ticks of the node "gnc".
namespace dmise::test {

inline constexpr std::string_view mcap_magic("\x89MCAP0\r\n", 8);
inline constexpr Tick sample_last_tick = 2;
inline const std::string sample_digest(32, 'a');

inline Scenario sample_scenario() {
  Scenario scenario;
  scenario.tick = {1'000'000'000};
  scenario.duration = {sample_last_tick * scenario.tick.ns};
  return scenario;
}

template <class T>
std::string bytes_of(T number) {
  return {reinterpret_cast<const char*>(&number), sizeof number};
}
inline std::string text_field(const std::string& text) {
  return bytes_of(std::uint32_t(text.size())) + text;
}
inline std::string record(std::uint8_t opcode, const std::string& body) {
  return bytes_of(opcode) + bytes_of(std::uint64_t(body.size())) + body;
}
inline std::string channel_record(std::uint16_t id, const std::string& topic,
                                  const std::string& schema) {
  return record(3, bytes_of(id) + text_field(schema)) +
         record(4, bytes_of(id) + bytes_of(id) + text_field(topic));
}
inline std::string message_record(std::uint16_t channel, const std::string& data) {
  return record(5, bytes_of(channel) + std::string(20, '\0') + data);
}
/// Without a checksum, so that a change of its records is none of it.
inline std::string chunk_record(const std::string& records, bool compressed) {
  std::string packed = records;
  if (compressed) {
    packed.resize(ZSTD_compressBound(records.size()));
    packed.resize(ZSTD_compress(packed.data(), packed.size(), records.data(), records.size(), 1));
  }
  return record(6, std::string(16, '\0') + bytes_of(std::uint64_t(records.size())) +
                       bytes_of(std::uint32_t(0)) + text_field(compressed ? "zstd" : "") +
                       bytes_of(std::uint64_t(packed.size())) + packed);
}

inline ObjectStates states_at(Tick tick) {
  return {.tick = tick,
          .time = sample_scenario().time_of(tick),
          .count = 1,
          .position_m = {7e6, 0, double(tick)},
          .slope_m_per_s = {0, 0, 1},
          .velocity_m_per_s = {0, 0, 1},
          .code = {0}};
}
inline std::string recorded(const State& state, const std::string& envelope = "") {
  const Encoded body = encode(state);
  google::protobuf::UnknownFieldSet fields;  // fields of RecordedMessage
  fields.AddLengthDelimited(1)->assign(envelope);
  fields.AddLengthDelimited(2)->assign(body.arrays);
  fields.AddLengthDelimited(int(body.kind))->assign(body.payload);
  std::string record;
  fields.SerializeToString(&record);
  return record;
}

/// The envelope of the last message of a tick.
inline std::string envelope_of_last(Tick tick) {
  v1::Envelope envelope;
  envelope.set_tick(tick);
  envelope.set_last_of_tick(true);
  return envelope.SerializeAsString();
}

/// What says of which run the records are.
inline std::string run_records() {
  v1::Endpoints run;
  run.set_tick_ns(sample_scenario().tick.ns);
  run.set_scenario_digest(sample_digest);
  return channel_record(1, "run", "dmise.v1.Endpoints") +
         message_record(1, run.SerializeAsString());
}

/// The records of the node "gnc".
inline std::string sample_records(Tick last_tick = sample_last_tick) {
  std::string records =
      run_records() + channel_record(2, "state/actor/gnc", "dmise.v1.RecordedMessage");
  for (Tick tick = 0; tick <= last_tick; ++tick)
    records += message_record(2, recorded(states_at(tick)));
  return records;
}

}  // namespace dmise::test
