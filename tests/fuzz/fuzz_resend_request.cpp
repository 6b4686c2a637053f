// Hostile questions for what a node has published, as its heartbeat thread judges and answers them.
#include "nodes/runtime/protocol/control_rules.h"
#include "nodes/runtime/protocol/outbox.h"
#include "tests/fuzz/chunks.h"
#include "tests/wire/examples.h"

namespace {

using namespace dmise;

const Outbox& outbox() {
  static const Outbox* filled = [] {
    const RunFacts run = test::example_run();
    auto* box = new Outbox(run, "source", 1, {environment_topic, objects_topic}, 3);
    for (Tick tick = 0; tick < 6; ++tick) {
      std::vector<Message> messages;
      for (test::Example& example : test::examples(unsigned(tick + 23)))  // this tick only
        if (std::holds_alternative<EnvironmentState>(example.state) && example.tick == tick)
          messages.push_back({example.topic, tick, std::make_shared<const State>(example.state)});
      box->pack(tick, messages);
    }
    return box;
  }();
  return *filled;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  v1::ResendRequest request;
  if (!request.ParseFromArray(data, int(size)) || fault_of(request)) return 0;
  const auto answer = request.catch_up() ? outbox().catch_up(request.topic(), request.from_tick())
                                         : outbox().since(request.topic(), request.from_sequence());
  for (const SharedFrames& frames : answer) {
    const std::string_view views[]{frames->topic, frames->envelope, frames->payload,
                                   frames->arrays};
    const Envelope envelope = open({views, frames->arrays.empty() ? 3u : 4u});
    if (frames->topic != request.topic() || envelope.publisher != "source" || envelope.tick < 0 ||
        (!request.catch_up() && envelope.sequence < request.from_sequence()))
      __builtin_trap();
  }
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned seed) {
  if (size == 0 || seed % 8 == 0) {
    v1::ResendRequest request;
    request.set_run_id(seed);
    request.set_topic(seed & 8 ? environment_topic : objects_topic);
    request.set_from_sequence(seed >> 8 & 7);
    request.set_catch_up(seed & 16);
    request.set_from_tick(seed >> 12 & 15);
    fuzz::place(request.SerializeAsString(), data, &size, max_size);
  }
  return LLVMFuzzerMutate(data, size, max_size);
}
