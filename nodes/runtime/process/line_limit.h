#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/base/instant.h"

namespace dmise {

/// Limits log lines of one kind: admits the first few of each interval and counts the others.
class LineLimit {
 public:
  explicit LineLimit(std::uint64_t most = 10, Instant interval = std::chrono::seconds(10))
      : most_(most), interval_(interval) {}

  /// Whether to write a line of this kind. The set of kinds must be small.
  bool admit(const std::string& kind, Instant now) {
    Count& count = counts_.try_emplace(kind, Count{now, 0, 0}).first->second;
    if (now - count.since >= interval_ && count.left_out == 0) count = {now, 0, 0};
    if (count.written < most_) {
      ++count.written;
      return true;
    }
    ++count.left_out;
    return false;
  }

  /// Kinds with the number of suppressed lines, once their interval is over, or all (`at_end`).
  std::vector<std::pair<std::string, std::uint64_t>> take_left_out(Instant now,
                                                                   bool at_end = false) {
    std::vector<std::pair<std::string, std::uint64_t>> left_out;
    for (auto& [kind, count] : counts_) {
      if (count.left_out == 0 || (!at_end && now - count.since < interval_)) continue;
      left_out.emplace_back(kind, count.left_out);
      count = {now, 0, 0};
    }
    return left_out;
  }

 private:
  struct Count {
    Instant since{0};
    std::uint64_t written = 0, left_out = 0;
  };
  std::uint64_t most_;
  Instant interval_;
  std::map<std::string, Count> counts_;
};

}  // namespace dmise
