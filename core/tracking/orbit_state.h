#pragma once
#include <Eigen/Core>
#include <array>
#include <span>

#include "core/base/sim_time.h"
#include "core/frames/vec.h"

namespace dmise {

/// Position, velocity, drag and radiation pressure: the order of rows in vectors and covariances.
inline constexpr int orbit_size = 8;
inline constexpr int drag_row = 6, srp_row = 7;
using OrbitVector = Eigen::Matrix<double, orbit_size, 1>;
using OrbitMatrix = Eigen::Matrix<double, orbit_size, orbit_size>;

/// State of one object.
struct OrbitState {
  SimTime time;
  Vec<Gcrs> position_m;
  Vec<Gcrs> velocity_m_per_s;
  double drag_m2_per_kg = 0.0;  // drag coefficient times area over mass, Cd A / m, >= 0
  double srp_m2_per_kg = 0.0;   // radiation pressure coefficient times area over mass, Cr A / m

  bool operator==(const OrbitState&) const = default;
};

/// A state with its covariance, in GCRS and SI units of the state's rows. A scale (drag, radiation
/// pressure) whose row and column are zero is taken as known.
struct OrbitEstimate {
  OrbitState state;
  OrbitMatrix covariance = OrbitMatrix::Zero();
};

OrbitVector vector_of(const OrbitState& state);
OrbitState state_of(const OrbitVector& vector, SimTime time);

inline Eigen::Vector3d eigen_of(const Vec<Gcrs>& v) { return {v.x, v.y, v.z}; }
inline Vec<Gcrs> gcrs_of(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

/// All numbers finite, positions outside the Earth's centre, variances not negative.
bool is_sane(const OrbitState& state);
bool is_sane(const OrbitEstimate& estimate);

/// The first rows of a covariance's lower triangle, row by row, as in an OEM.
template <int rows, class Matrix>
std::array<double, rows*(rows + 1) / 2> lower_triangle(const Matrix& covariance) {
  std::array<double, rows*(rows + 1) / 2> out{};
  std::size_t k = 0;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column <= row; ++column) out[k++] = covariance(row, column);
  return out;
}

/// Columns: the radial, transverse and normal axes of its orbit.
Eigen::Matrix3d orbit_axes(const OrbitState& state);

/// Smallest and largest distance from the Earth's centre on the osculating conic [m]; an orbit
/// that does not return has an infinite apogee.
double perigee_m(const OrbitState& state);
double apogee_m(const OrbitState& state);

/// What an orbit near the Earth may be; candidates beyond are left out.
struct OrbitLimits {
  double min_perigee_m = 6.478e6;  // from the Earth's centre
  double largest_apogee_m = 5e8;
  bool open = false;  // parabolas and hyperbolas are taken
};
bool within(const OrbitLimits& limits, const OrbitState& state);

/// Some rows of a covariance with unit variances, since metres and metres per second differ by
/// powers of ten, and their standard deviations. Rows of `scaled` beyond `rows` are the identity's.
struct UnitVariances {
  OrbitMatrix scaled = OrbitMatrix::Identity();
  OrbitVector sigma = OrbitVector::Ones();
};
UnitVariances unit_variances(const OrbitMatrix& covariance, std::span<const int> rows);

/// Normalised estimation error squared of the first `rows` rows: (truth - state)' P^-1 (truth -
/// state), of mean `rows`. `truth` must be at the same time. Infinite if P is not positive
/// definite.
double nees(const OrbitEstimate& estimate, const OrbitState& truth, int rows = 6);

}  // namespace dmise
