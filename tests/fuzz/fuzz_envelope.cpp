// Hostile frames for the receiver: topic, envelope, payload, arrays, each after its length. Where
// the first byte is odd the seal is made right, so that the fuzzer gets past it.
#include "core/base/files/crc32c.h"
#include "nodes/wire/state_codec.h"
#include "tests/fuzz/chunks.h"
#include "tests/wire/examples.h"

namespace {

using namespace dmise;

std::string sealed_again(const std::vector<std::string_view>& frames) {
  std::string envelope(
      frames[1].substr(0, frames[1].size() - std::min<std::size_t>(5, frames[1].size())));
  std::uint32_t crc = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const std::string_view part = i == 1 ? std::string_view(envelope) : frames[i];
    crc = crc32c(part.data(), part.size(), crc);
  }
  envelope += '\x7d';
  for (int shift = 0; shift < 32; shift += 8) envelope += static_cast<char>(crc >> shift);
  return envelope;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static Receiver receiver = test::receiver_of_examples();
  if (size == 0) return 0;
  auto frames = fuzz::cut(fuzz::view(data + 1, size - 1), 6);
  std::string envelope;
  if (data[0] % 2 && frames.size() >= 3 && frames.size() <= 4) {
    envelope = sealed_again(frames);
    frames[1] = envelope;
  }
  const auto received = receiver.receive(frames);
  if (received && received->envelope.kind != MessageKind::probe &&
      (received->envelope.tick > test::example_run().last_tick || received->envelope.tick < 0 ||
       received->envelope.run_id != test::example_run().run_id ||
       received->envelope.publisher != "source"))
    __builtin_trap();
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned seed) {
  if (size < 8 || seed % 32 == 0) {
    static const auto inputs = [] {
      std::vector<std::string> all;
      for (const MessageKind kind : {MessageKind::probe, MessageKind::watermark,
                                     MessageKind::position, MessageKind::site_state})
        for (const test::Example& example : test::examples(unsigned(kind))) {
          const bool site = std::holds_alternative<SiteState>(example.state);
          if ((kind == MessageKind::site_state) != site) continue;
          const Frames frames =
              site ? test::sealed(example) : seal(example.topic, test::envelope_of(example, kind));
          std::string& input = all.emplace_back(1, '\x01');
          for (const auto* frame : {&frames.topic, &frames.envelope, &frames.payload})
            fuzz::append(input, *frame);
        }
      return all;
    }();
    if (fuzz::place(inputs[seed / 32 % inputs.size()], data, &size, max_size) && seed % 64 == 0)
      return size;
  }
  if (seed % 4 == 0 || size < 2) return LLVMFuzzerMutate(data, size, max_size);
  return 1 + fuzz::mutate_part(data + 1, size - 1, max_size - 1, seed / 4);
}
