#include <erfa.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/orbit/elements/epoch.h"
#include "core/orbit/oem.h"

namespace dmise {

namespace {

std::string utc_text(const Tai& time) {
  Utc utc;
  eraTaiutc(time.jd1, time.jd2, &utc.jd1, &utc.jd2);
  const double day = std::floor(utc.jd1 - 0.5 + utc.jd2);
  return format_iso_epoch({day + 0.5, (utc.jd1 - day - 0.5) + utc.jd2});
}

Tai later(const Tai& time, double seconds) { return {time.jd1, time.jd2 + seconds / 86400.0}; }

/// Lagrange's polynomial of one of `count` knots at `t`, and its slopes there and at the knot.
struct Basis {
  double value = 1.0, slope = 0.0, slope_at_knot = 0.0;
};

Basis lagrange_basis(const double* knots, int count, int k, double t) {
  Basis b;
  for (int j = 0; j < count; ++j) {
    if (j == k) continue;
    const double distance = knots[k] - knots[j];
    b.slope = b.slope * ((t - knots[j]) / distance) + b.value / distance;
    b.value *= (t - knots[j]) / distance;
    b.slope_at_knot += 1.0 / distance;
  }
  return b;
}

/// Velocity of an interpolated state, if the two differ (Lagrange, linear).
enum class Velocity { as_listed, slope_of_position };

MotionState<OemAxes> interpolated(const OemSegment& s, double t_s, Velocity velocity) {
  const bool hermite = s.interpolation == OemInterpolation::hermite;
  int count = s.interpolation == OemInterpolation::linear ? 2
              : hermite                                   ? (s.degree + 2) / 2
                                                          : s.degree + 1;
  const int size = static_cast<int>(s.time_s.size());
  count = std::min(count, size);
  const bool listed =
      !s.velocity_m_per_s.empty() && (velocity == Velocity::as_listed || count == 1);
  const auto after = std::upper_bound(s.time_s.begin(), s.time_s.end(), t_s);
  const int interval = std::max(0, static_cast<int>(after - s.time_s.begin()) - 1);
  const int first = std::clamp(interval - (count - 1) / 2, 0, size - count);
  MotionState<OemAxes> state;
  for (int k = 0; k < count; ++k) {
    const std::size_t i = static_cast<std::size_t>(first + k);
    const Basis b = lagrange_basis(s.time_s.data() + first, count, k, t_s);
    if (!hermite) {
      state.position_m += s.position_m[i] * b.value;
      state.velocity_m_per_s +=
          listed ? s.velocity_m_per_s[i] * b.value : s.position_m[i] * b.slope;
      continue;
    }
    const double dt_s = t_s - s.time_s[i], square = b.value * b.value;
    const double square_slope = 2 * b.value * b.slope, lever = 1 - 2 * b.slope_at_knot * dt_s;
    state.position_m +=
        s.position_m[i] * (lever * square) + s.velocity_m_per_s[i] * (dt_s * square);
    state.velocity_m_per_s +=
        s.position_m[i] * (lever * square_slope - 2 * b.slope_at_knot * square) +
        s.velocity_m_per_s[i] * (square + dt_s * square_slope);
  }
  return state;
}

template <class F>
MotionState<F> in_frame(const MotionState<OemAxes>& s) {
  return {{s.position_m.x, s.position_m.y, s.position_m.z},
          {s.velocity_m_per_s.x, s.velocity_m_per_s.y, s.velocity_m_per_s.z}};
}

/// Times are known to a nanosecond, so the span is extended by that.
constexpr double time_tolerance_s = 1e-9;

/// Returns the last segment that covers the time, which begins after a jump; null if there is none.
const OemSegment* segment_at(const Trajectory& trajectory, double t_s) {
  const OemSegment* segment = nullptr;
  for (const OemSegment& s : trajectory.segments)
    if (t_s >= s.usable_start_s - time_tolerance_s && t_s <= s.usable_stop_s + time_tolerance_s)
      segment = &s;
  return segment;
}

FramedState framed_state(const Trajectory& trajectory, const Tai& time, Velocity velocity) {
  const double t_s = seconds_between(trajectory.reference, time);
  const OemSegment* segment = segment_at(trajectory, t_s);
  if (!segment)
    throw Error(trajectory.source + ": " + trajectory.segments.front().object_name +
                ": no state at " + utc_text(time) + "; the trajectory spans " +
                span_text(trajectory));
  const MotionState<OemAxes> state = interpolated(*segment, t_s, velocity);
  switch (segment->frame) {
    case OemFrame::itrs:
      return in_frame<Itrs>(state);
    case OemFrame::teme:
      return in_frame<Teme>(state);
    case OemFrame::gcrs:
      break;
  }
  return in_frame<Gcrs>(state);
}

}  // namespace

bool covers(const Trajectory& trajectory, const Tai& time) {
  return segment_at(trajectory, seconds_between(trajectory.reference, time)) != nullptr;
}

TrajectorySpan span_of(const Trajectory& trajectory) {
  double start_s = trajectory.segments.front().usable_start_s;
  double stop_s = trajectory.segments.front().usable_stop_s;
  for (const OemSegment& s : trajectory.segments) {
    start_s = std::min(start_s, s.usable_start_s);
    stop_s = std::max(stop_s, s.usable_stop_s);
  }
  return {later(trajectory.reference, start_s), later(trajectory.reference, stop_s)};
}

std::string span_text(const Trajectory& trajectory) {
  const TrajectorySpan span = span_of(trajectory);
  return utc_text(span.start) + " to " + utc_text(span.stop) + " UTC";
}

FramedState state_at(const Trajectory& trajectory, const Tai& time) {
  return framed_state(trajectory, time, Velocity::as_listed);
}

FramedState path_at(const Trajectory& trajectory, const Tai& time) {
  return framed_state(trajectory, time, Velocity::slope_of_position);
}

}  // namespace dmise
