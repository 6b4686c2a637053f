#include "nodes/runtime/observability/tick_rate.h"

#include <algorithm>

namespace dmise {

void TickRate::take(Tick done, double now_s) {
  heard_s_ = now_s;
  if (!news_.empty() && done < news_.back().done) news_.clear();
  if (news_.empty() || done > news_.back().done) news_.push_back({now_s, done});
  while (news_.size() > 1 && news_[1].at_s <= now_s - window_s()) news_.pop_front();
}

double TickRate::window_s() const {
  constexpr double min_s = 15.0;
  const std::size_t n = news_.size();
  return n < 2 ? min_s : std::max(min_s, 3.0 * (news_[n - 1].at_s - news_[n - 2].at_s));
}

double TickRate::ticks_per_s() const {
  if (news_.size() < 2) return 0.0;
  const News &first = news_.front(), &last = news_.back();
  const double usual_s = (last.at_s - first.at_s) / double(news_.size() - 1);
  // Long without news: the clock is slower than it was.
  const double to_s = heard_s_ - last.at_s > 3.0 * usual_s ? heard_s_ : last.at_s;
  return double(last.done - first.done) / (to_s - first.at_s);
}

}  // namespace dmise
