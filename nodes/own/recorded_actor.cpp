#include "nodes/own/recorded_actor.h"

#include <google/protobuf/io/coded_stream.h>

#include <cstdint>
#include <utility>
#include <variant>

#include "core/base/error.h"
#include "core/base/printable.h"
#include "dmise/v1/time.pb.h"
#include "nodes/own/mcap_file.h"
#include "nodes/wire/state_codec.h"

namespace dmise {
namespace {

// Fields of RecordedMessage (proto/dmise/v1/recording.proto): their contents are those of frames.
constexpr int arrays_field = 2, states_field = int(MessageKind::object_states);

/// The states of a RecordedMessage; null if it has none, as a probe.
std::shared_ptr<const State> states_in(std::string_view record) {
  if (record.size() > max_array_bytes + max_payload_bytes) throw Error("not a RecordedMessage");
  google::protobuf::io::CodedInputStream input(reinterpret_cast<const std::uint8_t*>(record.data()),
                                               int(record.size()));
  std::string payload, arrays, other;
  while (const std::uint32_t tag = input.ReadTag()) {
    const int field = int(tag >> 3);
    std::string& bytes = field == states_field ? payload : field == arrays_field ? arrays : other;
    std::uint32_t size = 0;
    if ((tag & 7) != 2 || !input.ReadVarint32(&size) || !input.ReadString(&bytes, int(size)))
      throw Error("not a RecordedMessage");
  }
  if (payload.empty()) return nullptr;
  return std::make_shared<const State>(decode(MessageKind::object_states, payload, arrays));
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

RecordedActor::RecordedActor(const Scenario& scenario, std::string node, const std::string& digest,
                             const std::string& path)
    : node_(std::move(node)), topic_(actor_prefix + node_) {
  bool is_of_run = false;
  const auto ticks = std::size_t(scenario.last_tick() + 1);
  const auto hear = [&](const McapMessage& message) {
    if (message.channel == "run" && message.schema == "dmise.v1.Endpoints" && !is_of_run) {
      check_run(message.data, scenario, digest);
      is_of_run = true;
    }
    if (message.channel != topic_) return true;
    add(message.data, scenario);
    return states_.size() < ticks;
  };
  try {
    read_mcap(path, hear);
    if (!is_of_run) throw ConfigError("does not say of which run it is");
    if (states_.empty()) throw ConfigError("has nothing of node " + node_);
    if (states_.size() < ticks)
      throw ConfigError("ends after tick " + std::to_string(states_.size() - 1) + " of node " +
                        node_ + ", the run has " + std::to_string(ticks - 1));
  } catch (const ConfigError& error) {
    const std::string what = error.what();
    throw ConfigError(what.starts_with(path) ? what : path + ": " + what);
  }
}

void RecordedActor::add(std::string_view record, const Scenario& scenario) {
  const auto state = states_in(record);
  if (!state) return;
  const auto& states = std::get<ObjectStates>(*state);
  const Tick due = Tick(states_.size());
  if (states.tick > due)
    throw ConfigError("lacks tick " + std::to_string(due) + " of node " + node_);
  if (states.tick < due) return;  // said again
  if (states.time != scenario.time_of(due))
    throw ConfigError("tick " + std::to_string(due) + " of node " + node_ + " is not at its time");
  states_.push_back(state);
}

std::vector<Message> RecordedActor::step(Tick tick, std::span<const Message>) {
  return {{topic_, tick, states_.at(std::size_t(tick))}};
}

}  // namespace dmise
