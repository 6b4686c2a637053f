#pragma once

namespace dmise {

/// How a process spent the time of a run.
struct TimeSplit {
  double compute_s = 0.0;    // in steps
  double messaging_s = 0.0;  // encoding, sending, receiving, checking
  double waiting_s = 0.0;    // for the clock or for inputs

  bool operator==(const TimeSplit&) const = default;
};

}  // namespace dmise
