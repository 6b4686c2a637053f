#pragma once
#include "sensors/observatory/drive.h"

namespace dmise {

/// Numbers are those of ASCOM's CoverStatus.
enum class CoverState { closed = 1, moving = 2, open = 3, unknown = 4 };

/// The cover of a telescope. Calls throw `DeviceError`.
class Cover {
 public:
  static constexpr double seconds_to_open = 2.0;

  /// It is open.
  Cover() : drive_("cover", 1.0, 1.0 / seconds_to_open) {}

  CoverState state(SimTime now) const;
  bool is_going_to_open() const { return drive_.goal() > 0.0; }
  void open(SimTime now) { drive_.move_to(1.0, now); }
  void close(SimTime now) { drive_.move_to(0.0, now); }
  /// It stays half open, if it moved.
  void halt(SimTime now) { drive_.halt(now); }
  /// Refuses an exposure behind a cover that is neither open nor closed.
  void need_still(SimTime now) const;
  void hold_until(SimTime end) { drive_.hold_until(end); }

 private:
  Drive drive_;  // 0: closed, 1: open
};

}  // namespace dmise
