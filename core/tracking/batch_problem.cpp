#include "core/tracking/batch_problem.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/tracking/line_of_light.h"
#include "core/tracking/triangle.h"

namespace dmise {

BatchProblem::BatchProblem(const ForceModel& forces, std::span<const AngleObservation> observations,
                           const OrbitState& start, const BatchSettings& settings)
    : forces_(forces), observations_(observations), settings_(settings), epoch_(start.time) {
  unknowns_ = {0, 1, 2, 3, 4, 5};
  if (settings.estimate_drag) unknowns_.push_back(drag_row);
  if (settings.estimate_srp) unknowns_.push_back(srp_row);
  std::vector<std::size_t> order(observations.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return observations[a].time < observations[b].time;
  });
  // From the start to later times, and from the start to earlier ones.
  for (const std::size_t i : order)
    if (observations[i].time >= epoch_) later_.push_back(i);
  for (auto i = order.rbegin(); i != order.rend(); ++i)
    if (observations[*i].time < epoch_) earlier_.push_back(*i);
  for (const AngleObservation& o : observations)
    whitening_.push_back(
        Eigen::Matrix2d(Eigen::LLT<Eigen::Matrix2d>(covariance_of(o)).matrixL()).inverse());
}

std::string_view BatchProblem::linearise(const OrbitState& start, bool with_derivatives,
                                         LinearisedArc& out) const {
  const std::size_t n = observations_.size();
  out.residuals_rad.resize(n);
  out.white.resize(n);
  out.sigmas.resize(n);
  if (with_derivatives) out.derivatives.resize(n);
  for (const auto* side : {&later_, &earlier_}) {
    StateTransition at{start};
    for (const std::size_t i : *side) {
      const AngleObservation& seen = observations_[i];
      if (at.state.time != seen.time) {
        if (with_derivatives) {
          const auto moved =
              propagate_with_transition(forces_, at.state, seen.time, settings_.propagation);
          if (!moved) return moved.reason;
          at.transition = (moved->transition * at.transition).eval();
          at.state = moved->state;
        } else {
          const auto moved = propagate(forces_, at.state, seen.time, settings_.propagation);
          if (!moved) return moved.reason;
          at.state = *moved;
        }
      }
      observe(i, at, with_derivatives, out);
    }
  }
  for (const double sigma : out.sigmas)
    if (!std::isfinite(sigma)) return "the residuals are not finite";
  return {};
}

OrbitState BatchProblem::moved(const OrbitState& start, const OrbitVector& change) const {
  OrbitVector x = vector_of(start);
  for (int i = 0; i < unknowns(); ++i) x[unknowns_[std::size_t(i)]] += change[i];
  return state_of(x, start.time);
}

void BatchProblem::observe(std::size_t i, const StateTransition& at, bool with_derivatives,
                           LinearisedArc& out) const {
  const AngleObservation& seen = observations_[i];
  const OrbitVector x = vector_of(at.state);
  const LineOfLight line = line_of_light(x.head<3>(), x.segment<3>(3), eigen_of(seen.sensor_m));
  const Vec<Gcrs> direction = gcrs_of(line.line_m / std::max(line.range_m, 1e-9));
  out.residuals_rad[i] = angles_between(direction, seen.direction);
  out.white[i] = whitening_[i] * out.residuals_rad[i];
  out.sigmas[i] = out.white[i].norm();
  if (!with_derivatives) return;
  const Eigen::Matrix<double, 2, orbit_size> h =
      whitening_[i] * angle_derivatives(line, sky_tangents(direction)) * at.transition.topRows<6>();
  out.derivatives[i].setZero();
  for (int k = 0; k < unknowns(); ++k) out.derivatives[i].col(k) = h.col(unknowns_[std::size_t(k)]);
}

void fold(BatchTriangle& triangle, const Eigen::Matrix<double, 1, orbit_size>& row, double white) {
  Eigen::Matrix<double, orbit_size + 1, orbit_size + 1> stack;
  stack << triangle, row, white;
  triangularise<orbit_size>(stack);
  triangle = stack.topRows<orbit_size>();
}

}  // namespace dmise
