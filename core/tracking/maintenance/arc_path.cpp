#include "core/tracking/maintenance/arc_path.h"

#include <algorithm>
#include <cmath>

#include "core/tracking/propagate.h"

namespace dmise {
namespace {

constexpr double step_s = 300.0;  // between states of the chain of derivatives
// Derivatives need less than paths: a step of 10 cm changes them by 1e-8 of themselves.
constexpr PropagationSettings derivative_steps{.position_tolerance_m = 0.1};
// A third of the noise that is taken for the forces at the best is 1 m after a day.
constexpr NumericalFlightSettings flight_steps{.position_tolerance_m = 1e-4};

}  // namespace

ArcPath::ArcPath(const MaintenanceForces& forces, const OrbitState& start, SimTime end,
                 std::vector<OemSegment> segments)
    : forces_(&forces),
      start_(start),
      end_(end),
      path_{"an arc", forces.clock().tai({0}), std::move(segments)} {}

Outcome<ArcPath> ArcPath::fly(const MaintenanceForces& forces, const OrbitState& start,
                              std::span<const VelocityChange> changes, SimTime to) {
  using Result = Outcome<ArcPath>;
  if (!is_sane(start)) return Result::refused("the state is not finite or out of range");
  NumericalFlight flight{.epoch_s = start.time.seconds(),
                         .state = {start.position_m, start.velocity_m_per_s},
                         .from_s = std::min(start.time, to).seconds(),
                         .to_s = std::max(start.time, to).seconds()};
  for (const VelocityChange& change : changes)
    flight.manoeuvres.push_back(
        {.at_s = change.time.seconds(), .delta_v_m_per_s = change.delta_v_m_per_s});
  NumericalPath path = integrate_flight(forces.flight(start.drag_m2_per_kg, start.srp_m2_per_kg),
                                        flight, flight_steps);
  if (!path.ends.empty() || path.segments.empty())
    return Result::refused("the path enters the Earth");
  ArcPath out(forces, start, to, std::move(path.segments));
  if (const std::string_view reason = out.chain(); !reason.empty()) return Result::refused(reason);
  return out;
}

std::string_view ArcPath::chain() {
  OrbitMatrix all = OrbitMatrix::Identity();
  OrbitState from = start_;
  const double sense = end_ < start_.time ? -1 : 1;
  for (SimTime time = start_.time;;) {
    states_.push_back(from);
    transitions_.push_back(all);
    time = time + sim_seconds(sense * step_s);
    if (sense * (time - end_).seconds() > 0) return {};
    const auto moved =
        propagate_with_transition(forces_->derivatives(), from, time, derivative_steps);
    if (!moved) return moved.reason;
    all = moved->transition * all;
    from = at(time);
  }
}

OrbitState ArcPath::at(SimTime time) const {
  const auto state = std::get<MotionState<Gcrs>>(state_at(path_, forces_->clock().tai(time)));
  return {time, state.position_m, state.velocity_m_per_s, start_.drag_m2_per_kg,
          start_.srp_m2_per_kg};
}

OrbitMatrix ArcPath::transition(SimTime time) const {
  const double steps = std::fabs((time - start_.time).seconds()) / step_s;
  const auto k = std::min(std::size_t(steps), states_.size() - 1);
  const auto moved =
      propagate_with_transition(forces_->derivatives(), states_[k], time, derivative_steps);
  return moved ? OrbitMatrix(moved->transition * transitions_[k]) : transitions_[k];
}

}  // namespace dmise
