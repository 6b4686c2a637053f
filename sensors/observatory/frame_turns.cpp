#include "sensors/observatory/frame_turns.h"

#include "core/base/cancellation.h"

namespace dmise {

FrameTurns::Turn FrameTurns::take(SimTime due, const std::atomic<bool>& unwanted) {
  std::unique_lock lock(mutex_);
  const auto mine = waiting_.insert(due);
  changed_.wait(lock, [&] { return unwanted || (free_ > 0 && *waiting_.begin() == due); });
  waiting_.erase(mine);
  changed_.notify_all();  // the next may be first now
  if (unwanted) throw Cancelled();
  --free_;
  return Turn(*this);
}

std::size_t FrameTurns::waiting() {
  const std::lock_guard lock(mutex_);
  return waiting_.size();
}

void FrameTurns::wake() {
  const std::lock_guard lock(mutex_);
  changed_.notify_all();
}

void FrameTurns::give_back() {
  const std::lock_guard lock(mutex_);
  ++free_;
  changed_.notify_all();
}

}  // namespace dmise
