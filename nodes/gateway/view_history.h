#pragma once
#include <cstddef>
#include <deque>
#include <mutex>
#include <optional>
#include <vector>

#include "nodes/gateway/latest_messages.h"

namespace dmise {

/// Kinds of messages whose past is kept.
inline constexpr MessageSlot slots_of_history[] = {MessageSlot::objects, MessageSlot::sensors,
                                                   MessageSlot::detections, MessageSlot::tracks,
                                                   MessageSlot::tasks};

/// What viewers saw at one simulation time.
struct ViewSnapshot {
  double time_s = 0.0;
  std::vector<SharedMessage> messages;  // what there is for `slots_of_history`
};

/// The past of a run, for viewers that look back. Covers the whole run in limited memory: when it
/// is full, every second snapshot is removed, and later ones are twice as far apart.
class ViewHistory {
 public:
  explicit ViewHistory(std::size_t max_bytes = std::size_t(64) << 20,
                       std::size_t max_snapshots = 2048)
      : max_bytes_(max_bytes), max_snapshots_(max_snapshots) {}

  /// Times must not decrease; snapshots nearer to the last than the present spacing are left out.
  void add(ViewSnapshot snapshot);
  /// Forgets all snapshots.
  void clear();
  /// The last snapshot at or before `time_s`, or the first; empty if there is none.
  std::optional<ViewSnapshot> at(double time_s) const;

  struct Span {
    double from_s = 0.0, to_s = 0.0;
    std::size_t snapshots = 0, bytes = 0;
  };
  Span span() const;

 private:
  void thin();

  std::size_t max_bytes_, max_snapshots_;
  mutable std::mutex mutex_;
  std::deque<ViewSnapshot> snapshots_;
  double spacing_s_ = 0.0;
  std::size_t bytes_ = 0;
};

}  // namespace dmise
