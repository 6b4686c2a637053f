#pragma once
#include <atomic>

namespace dmise {

/// Thrown by parallel loops of a thread whose work is no longer wanted. It is no error: only who
/// asked for the end catches it.
struct Cancelled {};

/// While it lives, parallel loops (`Threads`) that this thread starts end with `Cancelled` once
/// `asked` is true.
class CancellationScope {
 public:
  explicit CancellationScope(const std::atomic<bool>& asked);
  ~CancellationScope();
  CancellationScope(const CancellationScope&) = delete;
  CancellationScope& operator=(const CancellationScope&) = delete;

 private:
  const std::atomic<bool>* before_;
};

/// What the innermost scope of this thread looks at; null without one.
const std::atomic<bool>* cancellation_flag();

}  // namespace dmise
