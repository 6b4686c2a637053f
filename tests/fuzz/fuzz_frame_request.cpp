// Hostile questions for frames, as a sensor's frame endpoint judges and answers them.
#include <algorithm>

#include "core/base/error.h"
#include "core/products/frame_report.h"
#include "nodes/runtime/protocol/control_rules.h"
#include "nodes/runtime/protocol/kept_frames.h"
#include "tests/fuzz/chunks.h"
#include "tests/wire/examples.h"

namespace {

using namespace dmise;

constexpr std::uint32_t first = 3, last = 9;

/// Frames 3, 5, 7 and 9; the file of 5 is gone.
const KeptFrames& frames() {
  static const KeptFrames* filled = [] {
    auto* kept = new KeptFrames("a");
    const auto examples = test::examples(1);
    for (std::uint32_t number = first; number <= last; number += 2)
      for (const test::Example& example : examples)
        if (const auto* found = std::get_if<FrameReport>(&example.state)) {
          FrameReport report = *found;
          report.frame = number;
          kept->add(report, [number]() -> FrameBytes {
            if (number == 5) throw Error("gone");
            const auto bytes = std::make_shared<const std::string>(std::to_string(number));
            return {bytes, *bytes};
          });
          break;
        }
    return kept;
  }();
  return *filled;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  v1::FrameRequest request;
  if (!request.ParseFromArray(data, int(size)) || fault_of(request)) return 0;
  const auto answer = frames().answer(request, 1);
  if (!answer) {
    if (std::max(request.next_after(), request.latest_after()) < last) __builtin_trap();
    return 0;
  }
  const std::uint32_t number = answer->head.report().frame();
  if (answer->head.status() == v1::FrameAnswer::STATUS_SENT) {
    const bool right = (request.has_frame() && number == request.frame()) ||
                       (request.has_next_after() && number > request.next_after()) ||
                       (request.has_latest_after() && number == last);
    if (!right || answer->fits.bytes != std::to_string(number)) __builtin_trap();
  } else if (!answer->fits.bytes.empty()) {
    __builtin_trap();
  }
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned seed) {
  if (size == 0 || seed % 8 == 0) {
    v1::FrameRequest request;
    request.set_run_id(seed);
    const std::uint32_t number = seed >> 8 & 15;
    if (seed & 8)
      request.set_frame(number);
    else if (seed & 16)
      request.set_next_after(number);
    else
      request.set_latest_after(number);
    fuzz::place(request.SerializeAsString(), data, &size, max_size);
  }
  return LLVMFuzzerMutate(data, size, max_size);
}
