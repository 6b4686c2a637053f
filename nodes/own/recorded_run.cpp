#include "nodes/own/recorded_run.h"

#include <google/protobuf/io/coded_stream.h>

#include <cstdint>
#include <utility>

#include "core/base/error.h"
#include "core/base/printable.h"
#include "dmise/v1/node.pb.h"
#include "dmise/v1/time.pb.h"
#include "nodes/own/mcap_file.h"
#include "nodes/wire/state_codec.h"

namespace dmise {
namespace {

// Fields of RecordedMessage (proto/dmise/v1/recording.proto): their contents are those of frames.
constexpr int envelope_field = 1, arrays_field = 2, first_kind = int(MessageKind::object_roster),
              last_kind = int(MessageKind::task_set);

RecordedState state_in(const McapMessage& message) {
  const std::string_view record = message.data;
  if (record.size() > max_array_bytes + max_payload_bytes) throw Error("not a RecordedMessage");
  google::protobuf::io::CodedInputStream input(reinterpret_cast<const std::uint8_t*>(record.data()),
                                               int(record.size()));
  std::string envelope, payload, arrays, other;
  int kind = 0;
  while (const std::uint32_t tag = input.ReadTag()) {
    const int field = int(tag >> 3);
    const bool is_payload = field >= first_kind && field <= last_kind;
    std::string& bytes = is_payload                ? payload
                         : field == envelope_field ? envelope
                         : field == arrays_field   ? arrays
                                                   : other;
    if (is_payload) kind = field;
    std::uint32_t size = 0;
    if ((tag & 7) != 2 || !input.ReadVarint32(&size) || !input.ReadString(&bytes, int(size)))
      throw Error("not a RecordedMessage");
  }
  RecordedState recorded{.topic = std::string(message.channel), .state = nullptr};
  v1::Envelope head;
  if (!head.ParseFromString(envelope)) throw Error("not a RecordedMessage");
  if (head.last_of_tick()) recorded.complete_to = head.tick();
  if (!payload.empty())
    recorded.state = std::make_shared<const State>(decode(MessageKind(kind), payload, arrays));
  return recorded;
}

void check_run(std::string_view record, const Scenario& scenario, const std::string& digest) {
  v1::Endpoints run;
  if (!run.ParseFromArray(record.data(), int(record.size()))) throw Error("not an Endpoints");
  if (run.tick_ns() != scenario.tick.ns)
    throw ConfigError("its ticks have " + std::to_string(run.tick_ns()) +
                      " ns, those of the scenario " + std::to_string(scenario.tick.ns));
  if (run.scenario_digest() != digest)
    throw ConfigError("is of another scenario, seed, plan or file: digest " +
                      printable(run.scenario_digest(), 40) + ", that of the scenario is " + digest);
}

}  // namespace

void read_recorded_run(const Scenario& scenario, const std::string& digest, const std::string& path,
                       const std::set<std::string>& topics,
                       const std::function<bool(const RecordedState&)>& hear,
                       const std::function<void()>& finish) {
  bool is_of_run = false;
  const auto hear_message = [&](const McapMessage& message) {
    if (message.channel == "run" && message.schema == "dmise.v1.Endpoints" && !is_of_run) {
      check_run(message.data, scenario, digest);
      is_of_run = true;
    }
    return !topics.contains(std::string(message.channel)) || hear(state_in(message));
  };
  try {
    read_mcap(path, hear_message);
    if (!is_of_run) throw ConfigError("does not say of which run it is");
    finish();
  } catch (const ConfigError& error) {
    const std::string what = error.what();
    throw ConfigError(what.starts_with(path) ? what : path + ": " + what);
  }
}

}  // namespace dmise
