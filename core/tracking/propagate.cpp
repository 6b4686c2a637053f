#include "core/tracking/propagate.h"

#include <unsupported/Eigen/AutoDiff>

#include "core/tracking/integrate.h"

namespace dmise {

namespace {

using Dual = Eigen::AutoDiffScalar<OrbitVector>;

constexpr std::string_view not_sane = "the state is not finite or out of range";

Path<double> path_of(const OrbitState& s) {
  const Vec<Gcrs>&r = s.position_m, &v = s.velocity_m_per_s;
  return {{r.x, r.y, r.z}, {v.x, v.y, v.z}, s.drag_m2_per_kg, s.srp_m2_per_kg};
}

Path<Dual> dual_path_of(const OrbitState& s) {
  const OrbitVector x = vector_of(s);
  const auto of = [&](int row) { return Dual(x[row], orbit_size, row); };
  return {{of(0), of(1), of(2)}, {of(3), of(4), of(5)}, of(drag_row), of(srp_row)};
}

}  // namespace

Outcome<OrbitState> propagate(const ForceModel& forces, const OrbitState& state, SimTime to,
                              const PropagationSettings& settings) {
  using Result = Outcome<OrbitState>;
  if (!is_sane(state)) return Result::refused(not_sane);
  if (to == state.time) return state;
  Path<double> path = path_of(state);
  const ForceSettings acting = acting_on(forces.settings(), path, false, false);
  const std::string_view reason =
      integrate(forces, acting, state.time, (to - state.time).seconds(), settings, path);
  if (!reason.empty()) return Result::refused(reason);
  return OrbitState{
      to, {path.r.x, path.r.y, path.r.z}, {path.v.x, path.v.y, path.v.z}, path.drag, path.srp};
}

Outcome<StateTransition> propagate_with_transition(const ForceModel& forces,
                                                   const OrbitState& state, SimTime to,
                                                   const PropagationSettings& settings) {
  using Result = Outcome<StateTransition>;
  if (!is_sane(state)) return Result::refused(not_sane);
  StateTransition out{state};
  if (to == state.time) return out;
  Path<Dual> path = dual_path_of(state);
  const ForceSettings acting = acting_on(forces.settings(), path, true, true);
  const std::string_view reason =
      integrate(forces, acting, state.time, (to - state.time).seconds(), settings, path);
  if (!reason.empty()) return Result::refused(reason);
  const Dual* rows[orbit_size] = {&path.r.x, &path.r.y, &path.r.z,  &path.v.x,
                                  &path.v.y, &path.v.z, &path.drag, &path.srp};
  OrbitVector x;
  for (int i = 0; i < orbit_size; ++i) {
    x[i] = rows[i]->value();
    out.transition.row(i) = rows[i]->derivatives().transpose();
  }
  out.state = state_of(x, to);
  return out;
}

Outcome<OrbitEstimate> propagate(const ForceModel& forces, const OrbitEstimate& estimate,
                                 SimTime to, const PropagationSettings& settings) {
  using Result = Outcome<OrbitEstimate>;
  if (!is_sane(estimate)) return Result::refused("the estimate is not finite or out of range");
  if (to == estimate.state.time) return estimate;
  const auto moved = propagate_with_transition(forces, estimate.state, to, settings);
  if (!moved) return Result::refused(moved.reason);
  const OrbitMatrix there = moved->transition * estimate.covariance * moved->transition.transpose();
  return OrbitEstimate{moved->state, 0.5 * (there + there.transpose())};
}

}  // namespace dmise
