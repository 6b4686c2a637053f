// Hostile content under a good envelope and seal, for the receiver of published messages. Compiled
// once for each kind, DMISE_KIND. Input: payload and arrays, as `cut` takes them apart.
#include "nodes/wire/state_codec.h"
#include "nodes/wire/state_rules.h"
#include "tests/fuzz/chunks.h"
#include "tests/wire/examples.h"

namespace {

using namespace dmise;

constexpr MessageKind kind = MessageKind::DMISE_KIND;

const std::vector<test::Example>& examples() {
  static const auto all = [] {
    std::vector<test::Example> of_kind;
    for (unsigned seed = 0; seed < 8; ++seed)
      for (test::Example& example : test::examples(seed)) {
        if (auto* set = std::get_if<DetectionSet>(&example.state);
            set && set->detections.size() > 1)
          set->detections.resize(1);
        if (auto* set = std::get_if<TruthSet>(&example.state)) set->truths.resize(1);
        if (auto* set = std::get_if<TrackSet>(&example.state)) set->tracks.resize(1);
        if (auto* set = std::get_if<TaskSet>(&example.state)) set->tasks.resize(1);
        if (encode(example.state).kind == kind) of_kind.push_back(std::move(example));
      }
    return of_kind;
  }();
  return all;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static Receiver receiver = test::receiver_of_examples();
  static const test::Example& example = examples().front();
  static const Envelope envelope = test::envelope_of(example, kind);
  const auto parts = fuzz::cut(fuzz::view(data, size), 2);
  const auto part = [&](std::size_t i) { return i < parts.size() ? std::string(parts[i]) : ""; };
  const Frames frames = seal(example.topic, envelope, part(0), part(1));
  std::vector<std::string_view> views{frames.topic, frames.envelope, frames.payload};
  if (!frames.arrays.empty()) views.push_back(frames.arrays);
  const auto received = receiver.receive(views);
  if (!received) return 0;
  // What was accepted is a valid state that travels again.
  check(*received->state);
  const Encoded body = encode(*received->state);
  if (!(decode(body.kind, body.payload, body.arrays) == *received->state)) __builtin_trap();
  return 0;
}

// Starts from valid messages now and then: what is near them gets furthest.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned seed) {
  if (size < 4 || seed % 32 == 0) {
    static const auto inputs = [] {
      std::vector<std::string> all;
      for (const test::Example& example : examples()) {
        const Encoded body = encode(example.state);
        fuzz::append(all.emplace_back(), body.payload);
        if (!body.arrays.empty()) fuzz::append(all.back(), body.arrays);
      }
      return all;
    }();
    if (fuzz::place(inputs[seed / 32 % inputs.size()], data, &size, max_size) && seed % 64 == 0)
      return size;
  }
  return seed % 2 ? fuzz::mutate_part(data, size, max_size, seed / 2)
                  : LLVMFuzzerMutate(data, size, max_size);
}
