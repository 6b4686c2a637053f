#include "core/config/stated_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <span>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/time/iso8601.h"

namespace dmise {
namespace {

/// A motion with states at steps of a twentieth of a radian and less, from `from_s` to `to_s`.
OemSegment sampled(const std::function<FramedState(double)>& state_of, double from_s, double to_s) {
  constexpr int fewest_steps = 10;
  const double longest_s = std::min(60.0, (to_s - from_s) / fewest_steps);
  OemSegment segment{.usable_start_s = from_s, .usable_stop_s = to_s};
  for (double t = from_s;;) {
    const auto [r, v] = without_frame(state_of(t));
    segment.time_s.push_back(t);
    segment.position_m.push_back(r);
    segment.velocity_m_per_s.push_back(v);
    if (t >= to_s) return segment;
    const double distance = norm(r);
    const double step_s =
        std::min(longest_s, 0.05 * std::sqrt(distance * distance * distance / earth_gm_m3_per_s2));
    t = to_s - t < 1.5 * step_s ? to_s : t + step_s;
  }
}

}  // namespace

double since_start_s(const Clock& clock, const Tai& time) {
  return seconds_between(clock.tai({0}), time);
}

MotionState<OemAxes> without_frame(const FramedState& state) {
  return std::visit(
      [](const auto& s) {
        return MotionState<OemAxes>{
            {s.position_m.x, s.position_m.y, s.position_m.z},
            {s.velocity_m_per_s.x, s.velocity_m_per_s.y, s.velocity_m_per_s.z}};
      },
      state);
}

StatedMotion::StatedMotion(const Model& model, const Clock& clock)
    : model_(model), clock_(clock), batch_(best_simd_level()) {
  if (const auto* elements = std::get_if<MeanElements>(&model))
    batch_.append(std::span(elements, 1));
}

FramedState StatedMotion::at(double time_s) const {
  const SimTime time = sim_seconds(time_s);
  if (const auto* model = std::get_if<MotionModel>(&model_))
    return state_at(*model, clock_.tai(time));
  const Utc utc = clock_.utc(time);
  std::array<double, 3> r{}, v{};
  std::array<std::uint8_t, 1> code{};
  batch_.propagate(utc.jd1, utc.jd2, r, v, code);
  if (code[0] != 0) throw Error("SGP4 code " + std::to_string(code[0]) + " at " + format_utc(utc));
  return MotionState<Teme>{{r[0], r[1], r[2]}, {v[0], v[1], v[2]}};
}

std::vector<OemSegment> StatedMotion::until(double from_s, double to_s) const {
  if (const auto* model = std::get_if<MotionModel>(&model_))
    if (const auto* trajectory = std::get_if<Trajectory>(model))
      return shortened(*trajectory, to_s);
  if (!(from_s < to_s)) return {};
  OemSegment segment = sampled([&](double t) { return at(t); }, from_s, to_s);
  if (std::holds_alternative<MeanElements>(model_)) {
    segment.frame = OemFrame::teme;  // whose velocities are not slopes
    segment.interpolation = OemInterpolation::lagrange;
    segment.degree = 9;
  } else {
    segment.degree = 11;
  }
  return {segment};
}

std::vector<OemSegment> StatedMotion::shortened(const Trajectory& trajectory, double to_s) const {
  const double shift_s = since_start_s(clock_, trajectory.reference);
  std::vector<OemSegment> out;
  for (OemSegment segment : trajectory.segments) {
    segment.usable_start_s += shift_s;
    segment.usable_stop_s = std::min(segment.usable_stop_s + shift_s, to_s);
    for (double& t : segment.time_s) t += shift_s;
    if (segment.usable_start_s <= to_s) out.push_back(std::move(segment));
  }
  return out;
}

}  // namespace dmise
