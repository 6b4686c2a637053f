#include "sensors/light/row_window.h"

#include <algorithm>
#include <cmath>

namespace dmise {
namespace {

constexpr double found_within_s = 0.5e-9;
constexpr int max_steps = 60;  // halving alone brings the longest delay, 1e5 s, to 1e-13 s

/// Returns when an edge of the shutter, which is in the first row at `first`, meets the source [s
/// later]: where the time less the delay of the source's row changes its sign. By false position,
/// Illinois' way, and halving where that is slow.
template <class DelayAt>
double meeting_s(double last_delay_s, const DelayAt& delay_at_s) {
  double low = 0.0, high = last_delay_s;
  double below = -delay_at_s(low), above = high - delay_at_s(high);
  if (below >= 0.0) return low;
  if (above <= 0.0) return high;
  int side = 0;
  for (int k = 0; k < max_steps && high - low > found_within_s; ++k) {
    const double at = k % 4 == 3
                          ? 0.5 * (low + high)
                          : std::clamp(low - below * (high - low) / (above - below), low, high);
    const double off = at - delay_at_s(at);
    if (std::abs(off) <= found_within_s) return at;
    if (off < 0.0) {
      low = at;
      below = off;
      if (side < 0) above *= 0.5;
      side = -1;
    } else {
      high = at;
      above = off;
      if (side > 0) below *= 0.5;
      side = 1;
    }
  }
  return 0.5 * (low + high);
}

/// A source's distance from both edges of the shutter.
class Chase {
 public:
  Chase(const View& view, const RowAt& row_at)
      : view_(view),
        row_at_(row_at),
        all_(view.times_of_all_rows()),
        rows_(view.sensor().camera.optics.rows) {}

  /// Whether the source runs nearly as fast as the shutter, somewhere.
  bool is_fast() const {
    constexpr int steps = 4;
    double before_s = delay_s(all_.start);
    for (int k = 1; k <= steps; ++k) {
      const double now_s = delay_s(all_.at(double(k) / steps));
      if (std::abs(now_s - before_s) > 0.9 * all_.seconds() / steps) return true;
      before_s = now_s;
    }
    return false;
  }
  /// The only times at which a slow source meets the edges.
  FrameTimes of_slow() const {
    const FrameTimes& first = view_.times();
    return between(meeting(first.start), meeting(first.end));
  }
  /// The longest time that a fast one is in an open row.
  FrameTimes of_fast() const {
    constexpr int steps = 512, max_halvings = 32;
    const auto at = [&](int k) { return all_.at(double(k) / steps); };
    const auto edge = [&](SimTime shut, SimTime open) {
      for (int k = 0; k < max_halvings; ++k) {
        const SimTime t{shut.ns + (open.ns - shut.ns) / 2};
        (is_exposed(t) ? open : shut) = t;
      }
      return open;
    };
    FrameTimes longest = between(all_.start, all_.start);
    int from = -1;  // first step of those that are exposed
    for (int k = 0; k <= steps + 1; ++k) {
      const bool exposed = k <= steps && is_exposed(at(k));
      if (exposed && from < 0) from = k;
      if (exposed || from < 0) continue;
      const SimTime start = from > 0 ? edge(at(from - 1), at(from)) : at(from);
      const SimTime end = k <= steps ? edge(at(k), at(k - 1)) : at(steps);
      if (end - start > longest.end - longest.start) longest = between(start, end);
      from = -1;
    }
    return longest;
  }

 private:
  static constexpr double margin_px = 16.0;  // reach of a blur beyond the frame

  std::optional<double> row(SimTime t) const { return row_at_(t); }
  double delay_s(SimTime t) const {
    return view_.row_delay(row(t).value_or(0.5 * (rows_ - 1))).seconds();
  }
  SimTime meeting(SimTime opens) const {
    const double last_s = (all_.end - view_.times().end).seconds();
    return opens + sim_seconds(meeting_s(
                       last_s, [&](double s) { return delay_s(opens + sim_seconds(s)); }));
  }
  bool is_exposed(SimTime t) const {
    const auto y_px = row(t);
    if (!y_px || *y_px < -margin_px || *y_px > rows_ - 1 + margin_px) return false;
    const SimTime opens = view_.times().start + view_.row_delay(*y_px);
    return t >= opens && t <= opens + (view_.times().end - view_.times().start);
  }
  FrameTimes between(SimTime start, SimTime end) const {
    end = std::max(end, start + SimTime{1});
    return {all_.frame, start, {start.ns + (end.ns - start.ns) / 2}, end};
  }

  const View& view_;
  const RowAt& row_at_;
  FrameTimes all_;
  int rows_;
};

}  // namespace

FrameTimes row_window(const View& view, const RowAt& row_at) {
  const Chase chase(view, row_at);
  return chase.is_fast() ? chase.of_fast() : chase.of_slow();
}

Arc rolled(const View& view, const Arc& whole) {
  const FrameTimes all = view.times_of_all_rows();
  const double seconds = all.seconds();
  const auto share = [&](SimTime t) { return (t - all.start).seconds() / seconds; };
  const FrameTimes open = row_window(view, [&](SimTime t) { return place(whole, share(t)).y_px; });
  return part_of(whole, share(open.start), share(open.end));
}

}  // namespace dmise
