#pragma once
#include <chrono>
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

  bool operator==(const TimeSplit&) const = default;
};

/// Adds the time of its life to one part of the split.
class Stopwatch {
 public:
  explicit Stopwatch(double* total_s) : total_s_(total_s) {}
  ~Stopwatch() {
    *total_s_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  double* total_s_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace dmise
