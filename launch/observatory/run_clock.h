#pragma once
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "nodes/runtime/observability/status.h"
#include "sensors/observatory/observatory.h"

namespace dmise {

/// Simulation time of a paced run: between two ticks it passes at the run's pace, and it waits
/// where the run waits. It is behind the run by the time between two questions at most, and never
/// ahead of its next tick. Its beginning is that of the run's scenario.
class RunClock : public ObservatoryClock {
 public:
  /// `master`: address of the run's time-master. Throws `Error` if that does not answer,
  /// `ConfigError` if the run is over or is not paced.
  RunClock(const std::string& master, const Security& security);
  ~RunClock() override;
  RunClock(const RunClock&) = delete;
  RunClock& operator=(const RunClock&) = delete;

  /// UTC of the run's first tick; empty if the run does not tell it.
  const std::string& start_utc() const { return start_utc_; }
  SimTime now() const override;
  void wait_until(SimTime t, std::unique_lock<std::mutex>& lock,
                  std::condition_variable& changed) const override;
  /// Why the run has no more time; empty as long as it has.
  std::string ended() const;

 private:
  void take(const RunStatus& status);
  void follow();

  std::string master_, start_utc_;
  Security security_;
  mutable std::mutex mutex_;  // guards what follows
  std::condition_variable stopped_;
  bool stops_ = false;
  std::string ended_;
  double pace_ = 0.0, tick_s_ = 0.0;
  double granted_s_ = 0.0;         // time of the tick that the run may process
  double offset_s_ = 0.0;          // simulation time at the pace's zero
  mutable double latest_s_ = 0.0;  // that was told: time does not go back
  std::thread thread_;
};

/// Where simulation time is, of which the bounds are known at each answer: it passes at a pace, and
/// is moved as little as they ask. Returns the offset.
double paced_offset_s(double offset_s, double pace, double at_s, double granted_s, double tick_s);

}  // namespace dmise
