#include "core/tracking/orbit_state.h"

#include <Eigen/Cholesky>
#include <array>
#include <cmath>
#include <limits>

#include "core/forces/manoeuvre.h"
#include "core/orbit/two_body.h"

namespace dmise {

OrbitVector vector_of(const OrbitState& s) {
  OrbitVector x;
  x << s.position_m.x, s.position_m.y, s.position_m.z, s.velocity_m_per_s.x, s.velocity_m_per_s.y,
      s.velocity_m_per_s.z, s.drag_m2_per_kg, s.srp_m2_per_kg;
  return x;
}

OrbitState state_of(const OrbitVector& x, SimTime time) {
  return {time, {x[0], x[1], x[2]}, {x[3], x[4], x[5]}, x[drag_row], x[srp_row]};
}

bool is_sane(const OrbitState& state) {
  return vector_of(state).allFinite() && norm(state.position_m) > 1.0 &&
         norm(state.position_m) < 1e12 && norm(state.velocity_m_per_s) < 1e8 &&
         state.drag_m2_per_kg < 1e6 && std::fabs(state.srp_m2_per_kg) < 1e6;
}

bool is_sane(const OrbitEstimate& estimate) {
  return is_sane(estimate.state) && estimate.covariance.allFinite() &&
         (estimate.covariance.diagonal().array() >= 0).all();
}

Eigen::Matrix3d orbit_axes(const OrbitState& s) {
  const MotionState<Gcrs> state{s.position_m, s.velocity_m_per_s};
  Eigen::Matrix3d axes;
  axes << eigen_of(gcrs_from_rtn(state, {1, 0, 0})), eigen_of(gcrs_from_rtn(state, {0, 1, 0})),
      eigen_of(gcrs_from_rtn(state, {0, 0, 1}));
  return axes;
}

namespace {

/// Semi-latus rectum [m] and eccentricity.
struct Shape {
  double semilatus_m, eccentricity;
};

Shape shape_of(const OrbitState& state) {
  const Vec<Gcrs> h = cross(state.position_m, state.velocity_m_per_s);
  const Vec<Gcrs> e =
      cross(state.velocity_m_per_s, h) / earth_gm_m3_per_s2 - unit(state.position_m);
  return {dot(h, h) / earth_gm_m3_per_s2, norm(e)};
}

}  // namespace

double perigee_m(const OrbitState& state) {
  const Shape shape = shape_of(state);
  return shape.semilatus_m / (1 + shape.eccentricity);
}

double apogee_m(const OrbitState& state) {
  const Shape shape = shape_of(state);
  if (shape.eccentricity >= 1) return std::numeric_limits<double>::infinity();
  return shape.semilatus_m / (1 - shape.eccentricity);
}

bool within(const OrbitLimits& limits, const OrbitState& state) {
  if (!is_sane(state) || !(perigee_m(state) >= limits.min_perigee_m)) return false;
  const double apogee = apogee_m(state);
  return apogee <= limits.largest_apogee_m || (limits.open && std::isinf(apogee));
}

UnitVariances unit_variances(const OrbitMatrix& covariance, std::span<const int> rows) {
  UnitVariances out;
  const auto row = [&](int i) { return rows[std::size_t(i)]; };
  const int n = int(rows.size());
  for (int i = 0; i < n; ++i) out.sigma[i] = std::sqrt(covariance(row(i), row(i)));
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      out.scaled(i, j) = covariance(row(i), row(j)) / (out.sigma[i] * out.sigma[j]);
  return out;
}

double nees(const OrbitEstimate& estimate, const OrbitState& truth, int rows) {
  const OrbitVector error = vector_of(truth) - vector_of(estimate.state);
  constexpr std::array all{0, 1, 2, 3, 4, 5, drag_row, srp_row};
  const auto [scaled, sigma] =
      unit_variances(estimate.covariance, std::span(all).first(std::size_t(rows)));
  OrbitVector right = OrbitVector::Zero();
  right.head(rows) = error.head(rows).cwiseQuotient(sigma.head(rows));
  const Eigen::LLT<OrbitMatrix> root(scaled);
  if (!scaled.allFinite() || root.info() != Eigen::Success)
    return std::numeric_limits<double>::infinity();
  return root.matrixL().solve(right).squaredNorm();
}

}  // namespace dmise
