#include "time-master/tick_log.h"

#include "nodes/runtime/process/seconds.h"

namespace dmise {

double TickLog::since_start_s(Instant now) const { return to_seconds(now - *start_); }

void TickLog::grant(Tick first, Tick granted, Instant now) {
  if (granted < first || (granted_ && granted <= *granted_)) return;
  if (!start_) start_ = now;
  if (open_.empty()) waited_until_ = now;  // all was done: the clock waited for nobody
  for (Tick tick = granted_ ? *granted_ + 1 : first; tick <= granted; ++tick)
    open_[tick] = since_start_s(now);
  granted_ = granted;
}

void TickLog::settle(Tick settled, Instant now, const std::string& last) {
  if (!start_) return;
  for (auto tick = open_.begin(); tick != open_.end() && tick->first <= settled;
       tick = open_.erase(tick)) {
    records_.push_back({tick->first, tick->second, since_start_s(now), last});
    if (records_.size() > most) records_.pop_front();
  }
}

void TickLog::wait(const std::vector<std::string>& holding, Instant now) {
  for (const std::string& name : holding) waited_for_s_[name] += to_seconds(now - waited_until_);
  waited_until_ = now;
}

}  // namespace dmise
