#pragma once
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <set>

#include "core/base/sim_time.h"

namespace dmise {

/// Lets no more frames be made at a time than there are processors for: first those that are due
/// first, so that none is late for one that has time.
class FrameTurns {
 public:
  explicit FrameTurns(int at_a_time) : free_(at_a_time) {}

  /// A turn, until it ends.
  class Turn {
   public:
    explicit Turn(FrameTurns& turns) : turns_(turns) {}
    ~Turn() { turns_.give_back(); }
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

   private:
    FrameTurns& turns_;
  };

  /// Waits for the turn of a frame that is due at `due`. Throws `Cancelled` once it is `unwanted`
  /// and `wake` is called.
  Turn take(SimTime due, const std::atomic<bool>& unwanted);
  /// Number of frames that wait for their turn.
  std::size_t waiting();
  /// Lets those who wait see that they are unwanted.
  void wake();

 private:
  void give_back();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::multiset<SimTime> waiting_;  // when their frames are due
  int free_;
};

}  // namespace dmise
