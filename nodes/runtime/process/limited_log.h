#pragma once
#include <spdlog/spdlog.h>

#include <string>

#include "nodes/runtime/process/line_limit.h"
#include "nodes/runtime/process/monotonic_clock.h"

namespace dmise {

/// A log of what strangers do: ten lines of each kind in 10 s, and a line with the number of the
/// others. Used from one thread.
class LimitedLog {
 public:
  ~LimitedLog() { sum_up(true); }

  /// `kind`: one of a few names, in the plural.
  bool admits(const std::string& kind) { return lines_.admit(kind, now()); }
  void warn(const std::string& kind, const std::string& text) {
    if (admits(kind)) spdlog::warn("{}", text);
  }
  /// Says how many lines were left out, once their interval is over.
  void sum_up(bool at_end = false) {
    for (const auto& [kind, count] : lines_.take_left_out(now(), at_end))
      spdlog::warn("{} more {}, not written one by one", count, kind);
  }

 private:
  LineLimit lines_;
};

}  // namespace dmise
