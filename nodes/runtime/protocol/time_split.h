#pragma once
#include <cstdint>

namespace dmise {

/// How a process spent the time of a run, its products and its memory.
struct TimeSplit {
  double compute_s = 0.0;        // in steps
  double messaging_s = 0.0;      // encoding, sending, receiving, checking
  double waiting_s = 0.0;        // for the clock or for inputs
  std::uint64_t frames = 0;      // published
  std::uint64_t detections = 0;  // in all published frames
  double start_s = 0.0;          // from the start of the process until it was ready
  std::uint64_t peak_resident_bytes = 0, private_bytes = 0;
};

}  // namespace dmise
