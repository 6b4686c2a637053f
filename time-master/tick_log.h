#pragma once
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/base/instant.h"
#include "core/base/sim_time.h"

namespace dmise {

/// Times of a tick, in seconds since the first grant.
struct TickRecord {
  Tick tick = 0;
  double granted_s = 0.0, settled_s = 0.0;  // when it might be processed, and when all had done it
  std::string last;                         // the node that was done last: all others waited for it

  bool operator==(const TickRecord&) const = default;
};

/// Remembers when ticks were granted and done, the latest 10,000 of them.
class TickLog {
 public:
  /// `first`: the first tick of the run.
  void grant(Tick first, Tick granted, Instant now);
  /// `last`: the node whose message was the last that was missing.
  void settle(Tick settled, Instant now, const std::string& last);
  /// Whether enough time has passed since the last `wait` to ask for whom the clock waits.
  bool is_wait_due(Instant now) const { return start_ && now - waited_until_ >= wait_resolution; }
  /// Books the time since the last call to the nodes that the clock waited for in it.
  void wait(const std::vector<std::string>& holding, Instant now);
  /// Seconds in which the clock waited for a node: of nodes that it waited for together, each.
  const std::map<std::string, double>& waited_for_s() const { return waited_for_s_; }
  std::vector<TickRecord> records() const { return {records_.begin(), records_.end()}; }

 private:
  static constexpr std::size_t most = 10'000;
  static constexpr Instant wait_resolution = std::chrono::milliseconds(10);
  double since_start_s(Instant now) const;
  std::optional<Instant> start_;
  std::optional<Tick> granted_;
  std::map<Tick, double> open_;  // granted and not yet done
  std::deque<TickRecord> records_;
  Instant waited_until_{0};
  std::map<std::string, double> waited_for_s_;
};

}  // namespace dmise
