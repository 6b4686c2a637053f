// Hostile bytes for the receiver. The first byte of the input chooses what they are:
// 0: the frames of a message, each after its length; else: the content of a message of that kind
// under a good envelope and seal, so that the fuzzer reaches the meaning.
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "nodes/wire/state_codec.h"
#include "nodes/wire/state_rules.h"
#include "tests/wire/examples.h"

namespace {

using namespace dmise;

std::vector<std::string_view> cut(std::string_view bytes) {
  std::vector<std::string_view> frames;
  while (bytes.size() >= 2 && frames.size() < 6) {
    const std::size_t size = std::min<std::size_t>(
        bytes.size() - 2, std::size_t(std::uint8_t(bytes[0])) << 8 | std::uint8_t(bytes[1]));
    frames.push_back(bytes.substr(2, size));
    bytes.remove_prefix(2 + size);
  }
  return frames;
}

/// The other way round: an input that `cut` takes apart into these frames.
void append(std::string& bytes, std::string_view frame) {
  bytes += static_cast<char>(frame.size() >> 8);
  bytes += static_cast<char>(frame.size());
  bytes += frame;
}

/// What was accepted must be a valid state that travels again.
void use(const std::optional<Received>& received) {
  if (!received || !received->state) return;
  check(*received->state);
  const Encoded body = encode(*received->state);
  if (!(decode(body.kind, body.payload, body.arrays) == *received->state)) __builtin_trap();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static Receiver receiver = test::receiver_of_examples();
  static const auto examples = test::examples(1);
  if (size == 0) return 0;
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  if (data[0] == 0) {
    use(receiver.receive(cut(bytes)));
    return 0;
  }
  const test::Example& example = examples[data[0] % examples.size()];
  const auto parts = cut(bytes);
  const auto part = [&](std::size_t i) { return i < parts.size() ? std::string(parts[i]) : ""; };
  const MessageKind kind = encode(example.state).kind;
  const Frames frames = seal(example.topic, test::envelope_of(example, kind), part(0), part(1));
  std::vector<std::string_view> views{frames.topic, frames.envelope, frames.payload};
  if (!frames.arrays.empty()) views.push_back(frames.arrays);
  use(receiver.receive(views));
  return 0;
}

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

// Starts from valid messages now and then: what is near them gets furthest.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned seed) {
  if (size < 8 || seed % 16 == 0) {
    const auto examples = test::examples(seed);
    const std::size_t which = 8 + seed / 16 % examples.size();
    const Frames frames = test::sealed(examples[which - 8]);
    const bool whole = seed % 3 == 0;
    std::string input(1, static_cast<char>(whole ? 0 : which));
    if (whole) {
      append(input, frames.topic);
      append(input, frames.envelope);
    }
    append(input, frames.payload);
    if (!frames.arrays.empty()) append(input, frames.arrays);
    if (input.size() <= max_size) {
      size = input.size();
      std::memcpy(data, input.data(), size);
    }
  }
  return LLVMFuzzerMutate(data, size, max_size);
}
