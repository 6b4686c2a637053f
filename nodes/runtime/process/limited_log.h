#pragma once
#include <spdlog/spdlog.h>

#include <string>

#include "nodes/runtime/process/line_limit.h"
#include "nodes/runtime/process/monotonic_clock.h"

namespace dmise {

/// Rate-limited log of the actions of unknown peers: ten lines of each kind in 10 s, and the number
/// of the others. Used from one thread.
class LimitedLog {
 public:
  ~LimitedLog() { sum_up(true); }

  /// `kind`: one of a few names, in the plural.
  bool admits(const std::string& kind) { return lines_.admit(kind, now()); }
  void warn(const std::string& kind, const std::string& text) {
    if (admits(kind)) spdlog::warn("{}", text);
  }
  /// Logs how many lines were suppressed, once their interval is over.
  void sum_up(bool at_end = false) {
    for (const auto& [kind, count] : lines_.take_left_out(now(), at_end))
      spdlog::warn("{} more {} suppressed", count, kind);
  }

 private:
  LineLimit lines_;
};

}  // namespace dmise
