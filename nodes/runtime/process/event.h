#pragma once
#include <atomic>

namespace dmise {

/// A flag that a poll can wait for. May be set in a signal handler and from any thread.
class Event {
 public:
  Event();
  ~Event();
  Event(const Event&) = delete;
  Event& operator=(const Event&) = delete;

  void set();
  bool is_set() const { return flag_.load(std::memory_order_acquire); }
  /// Resets the flag.
  void clear();
  /// Readable while the flag is set.
  int fd() const { return fd_; }

 private:
  std::atomic<bool> flag_{false};
  int fd_ = -1;
};

/// The event that SIGINT, SIGTERM and SIGHUP set from now on, for an orderly exit. SIGHUP stays
/// ignored where it is (nohup).
Event& stop_signal();

}  // namespace dmise
