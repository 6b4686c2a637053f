#pragma once
#include <atomic>

#include "sensors/observatory/observatory.h"

namespace dmise {

/// Time as the test says.
class ManualClock : public ObservatoryClock {
 public:
  SimTime now() const override { return {now_ns_}; }
  void wait_until(SimTime, std::unique_lock<std::mutex>& lock,
                  std::condition_variable& changed) const override {
    changed.wait_for(lock, std::chrono::milliseconds(1));
  }
  void set(double t_s) { now_ns_ = sim_seconds(t_s).ns; }

 private:
  std::atomic<std::int64_t> now_ns_{0};
};

}  // namespace dmise
