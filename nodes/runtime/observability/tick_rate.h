#pragma once
#include <deque>

#include "core/base/sim_time.h"

namespace dmise {

/// How fast ticks are done, from what is heard of them now and then. Some ticks take much longer
/// than others, such as those with frames: the rate is the mean of the last 15 s, or of three
/// pieces of news where they are rarer, from one to another. It does not depend on how often it is
/// asked.
class TickRate {
 public:
  /// At `now_s`, of any clock, ticks up to `done` were done. One before the last begins anew.
  void take(Tick done, double now_s);
  /// Forgets all: the clock was paused.
  void reset() { news_.clear(); }
  double ticks_per_s() const;

 private:
  struct News {
    double at_s;
    Tick done;
  };
  double window_s() const;

  std::deque<News> news_;  // when a tick was first seen as done
  double heard_s_ = 0.0;
};

}  // namespace dmise
