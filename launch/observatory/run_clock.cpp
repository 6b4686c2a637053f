#include "launch/observatory/run_clock.h"

#include <algorithm>

#include "core/base/error.h"

namespace dmise {
namespace {

constexpr double patience_s =
    5.0;  // for the first answer, and without one until the run counts as lost
constexpr auto interval = std::chrono::milliseconds(20);  // between two questions

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

bool is_over(const RunStatus& status) {
  return status.phase == Phase::ended || status.phase == Phase::failed;
}

}  // namespace

double paced_offset_s(double offset_s, double pace, double at_s, double granted_s, double tick_s) {
  return std::clamp(offset_s, granted_s - pace * at_s, granted_s + tick_s - pace * at_s);
}

RunClock::RunClock(const std::string& master, const Security& security)
    : master_(master), security_(security) {
  if (master_.empty()) throw ConfigError("--run: the address of a time-master is missing");
  const RunStatus status = ask_master(master_, patience_s, security_);
  if (is_over(status)) throw ConfigError("--run: the run at " + master_ + " is over");
  if (status.pace <= 0.0)
    throw ConfigError(
        "--run: the run at " + master_ +
        " goes as fast as it can; network: {real_time: 1} or `dmise clock pace` paces it");
  start_utc_ = status.start_utc;
  offset_s_ = -status.pace * seconds_now();
  take(status);
  thread_ = std::thread([this] { follow(); });
}

RunClock::~RunClock() {
  {
    const std::lock_guard lock(mutex_);
    stops_ = true;
  }
  stopped_.notify_all();
  thread_.join();
}

void RunClock::take(const RunStatus& status) {
  const double at_s = seconds_now();
  if (status.pace != pace_) offset_s_ += (pace_ - status.pace) * at_s;
  pace_ = status.pace;
  // Before the first tick is granted no time passes.
  tick_s_ = status.granted < 0 ? 0.0 : status.tick_length.seconds();
  granted_s_ = double(std::max<Tick>(status.granted, 0)) * status.tick_length.seconds();
  offset_s_ = paced_offset_s(offset_s_, pace_, at_s, granted_s_, tick_s_);
  if (is_over(status)) ended_ = status.cause.empty() ? "the run is over" : status.cause;
}

void RunClock::follow() {
  double answered_s = seconds_now();
  std::unique_lock lock(mutex_);
  while (!stops_ && ended_.empty()) {
    stopped_.wait_for(lock, interval);
    if (stops_) return;
    lock.unlock();
    RunStatus status;
    std::string silence;
    try {
      status = ask_master(master_, 1.0, security_);
      answered_s = seconds_now();
    } catch (const Error& error) {
      silence = error.what();
    }
    lock.lock();
    if (silence.empty())
      take(status);
    else if (seconds_now() - answered_s > patience_s)
      ended_ = silence;
  }
}

SimTime RunClock::now() const {
  const std::lock_guard lock(mutex_);
  const double paced_s =
      std::clamp(offset_s_ + pace_ * seconds_now(), granted_s_, granted_s_ + tick_s_);
  latest_s_ = std::max(latest_s_, paced_s);
  return sim_seconds(latest_s_);
}

/// Returns early: the run may be paused or paced anew meanwhile.
void RunClock::wait_until(SimTime t, std::unique_lock<std::mutex>& lock,
                          std::condition_variable& changed) const {
  const double left_s = (t - now()).seconds();
  double pace = 0.0;
  {
    const std::lock_guard guard(mutex_);
    pace = pace_;
  }
  const double wait_s = pace > 0.0 ? std::clamp(left_s / pace, 0.0, 0.05) : 0.05;
  changed.wait_for(lock, std::chrono::duration<double>(wait_s));
}

std::string RunClock::ended() const {
  const std::lock_guard lock(mutex_);
  return ended_;
}

}  // namespace dmise
