#include <unsupported/Eigen/Polynomials>

#include "core/tracking/initial/initial_orbit.h"
#include "core/tracking/initial/three_lines.h"

namespace dmise {

namespace {

using Orbits = Outcome<std::vector<OrbitState>>;

/// The three lines, and the determinants of Curtis, Orbital Mechanics for Engineering Students,
/// algorithm 5.5.
struct Lines {
  std::array<Vec<Gcrs>, 3> sensor_m, direction;
  std::array<double, 3> light_left_s{};  // since the second reception
  double d0 = 0.0;                       // volume of the directions
  double d[3][3];                        // [site][direction left out]

  explicit Lines(std::span<const AngleObservation> three) {
    for (std::size_t i = 0; i < 3; ++i) {
      sensor_m[i] = three[i].sensor_m;
      direction[i] = three[i].direction;
      light_left_s[i] = (three[i].time - three[1].time).seconds();
    }
    const Vec<Gcrs> p[3] = {cross(direction[1], direction[2]), cross(direction[0], direction[2]),
                            cross(direction[0], direction[1])};
    d0 = dot(direction[0], p[0]);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) d[i][j] = dot(sensor_m[std::size_t(i)], p[j]);
  }

  /// Slant ranges if r2 = c1 r1 + c3 r3.
  std::array<double, 3> ranges(double c1, double c3) const {
    return {(-d[0][0] + d[1][0] / c1 - c3 / c1 * d[2][0]) / d0,
            (-c1 * d[0][1] + d[1][1] - c3 * d[2][1]) / d0,
            (-c1 / c3 * d[0][2] + d[1][2] / c3 - d[2][2]) / d0};
  }
  Vec<Gcrs> place(std::size_t i, double range_m) const {
    return sensor_m[i] + range_m * direction[i];
  }
};

/// Positive real roots of Gauss's equation for the middle distance [m].
std::vector<double> distances(const Lines& lines, double t1, double t3) {
  constexpr double mu = earth_gm_m3_per_s2, unit_m = 1e7;
  const double t = t3 - t1;
  const double a = (-lines.d[0][1] * t3 / t + lines.d[1][1] + lines.d[2][1] * t1 / t) / lines.d0;
  const double b =
      (lines.d[0][1] * (t3 * t3 - t * t) * t3 / t + lines.d[2][1] * (t * t - t1 * t1) * t1 / t) /
      (6 * lines.d0);
  const double e = dot(lines.sensor_m[1], lines.direction[1]);
  const double s2 = dot(lines.sensor_m[1], lines.sensor_m[1]);
  Eigen::Matrix<double, 9, 1> polynomial = Eigen::Matrix<double, 9, 1>::Zero();
  polynomial[8] = 1;
  polynomial[6] = -(a * a + 2 * a * e + s2) / (unit_m * unit_m);
  polynomial[3] = -2 * mu * b * (a + e) / std::pow(unit_m, 5);
  polynomial[0] = -mu * mu * b * b / std::pow(unit_m, 8);
  std::vector<double> out;
  if (!polynomial.allFinite()) return out;
  const Eigen::PolynomialSolver<double, 8> solver(polynomial);
  for (const auto& root : solver.roots())
    if (root.real() > 0 && std::fabs(root.imag()) < 1e-6 * root.real())
      out.push_back(root.real() * unit_m);
  std::sort(out.begin(), out.end());
  return out;
}

/// f and g of `state` after `dt_s`, exact on its conic; false where there is none.
bool lagrange(const OrbitState& state, double dt_s, double& f, double& g) {
  OrbitState moved = state;
  if (!move_two_body(moved, dt_s)) return false;
  const Vec<Gcrs> h = cross(state.position_m, state.velocity_m_per_s);
  const double h2 = dot(h, h);
  if (!(h2 > 0)) return false;
  f = dot(cross(moved.position_m, state.velocity_m_per_s), h) / h2;
  g = dot(cross(state.position_m, moved.position_m), h) / h2;
  return std::isfinite(f) && std::isfinite(g);
}

/// The state at the middle line, improved until its ranges settle. False if they do not.
bool improve(Lines lines, double distance_m, OrbitState& state) {
  constexpr double mu = earth_gm_m3_per_s2;
  const std::array<double, 3> received = lines.light_left_s;
  double t1 = received[0] - received[1], t3 = received[2] - received[1];
  const double u = mu / (distance_m * distance_m * distance_m);
  double f1 = 1 - u * t1 * t1 / 2, f3 = 1 - u * t3 * t3 / 2;
  double g1 = t1 * (1 - u * t1 * t1 / 6), g3 = t3 * (1 - u * t3 * t3 / 6);
  std::array<double, 3> ranges{}, before{};
  for (int i = 0; i < 200; ++i) {
    const double volume = f1 * g3 - f3 * g1;
    ranges = lines.ranges(g3 / volume, -g1 / volume);
    if (i > 0)  // two successive ones are averaged: they oscillate
      for (std::size_t k = 0; k < 3; ++k) ranges[k] = (ranges[k] + before[k]) / 2;
    for (const double range : ranges)
      if (!std::isfinite(range) || range <= 0 || range > 1e12) return false;
    state.position_m = lines.place(1, ranges[1]);
    state.velocity_m_per_s =
        (f1 * lines.place(2, ranges[2]) - f3 * lines.place(0, ranges[0])) / volume;
    if (!is_sane(state)) return false;
    double change = 0;
    for (std::size_t k = 0; k < 3; ++k)
      change = std::max(change, std::fabs(ranges[k] - before[k]) / ranges[k]);
    if (change < 1e-11) return true;
    before = ranges;
    // Light of a longer line left earlier.
    const double c = speed_of_light_m_per_s;
    t1 = received[0] - received[1] - (ranges[0] - ranges[1]) / c;
    t3 = received[2] - received[1] - (ranges[2] - ranges[1]) / c;
    double next_f1, next_g1, next_f3, next_g3;
    if (!lagrange(state, t1, next_f1, next_g1) || !lagrange(state, t3, next_f3, next_g3))
      return false;
    f1 = (f1 + next_f1) / 2;
    f3 = (f3 + next_f3) / 2;
    g1 = (g1 + next_g1) / 2;
    g3 = (g3 + next_g3) / 2;
  }
  return false;
}

}  // namespace

Outcome<std::vector<OrbitState>> gauss_orbit(std::span<const AngleObservation> three,
                                             const OrbitLimits& limits) {
  if (const auto fault = fault_of_three(three); !fault.empty()) return Orbits::refused(fault);
  const Lines lines(three);
  const double sines = norm(cross(three[0].direction, three[1].direction)) *
                       norm(cross(three[1].direction, three[2].direction));
  // If the lines lie in one plane, errors alone give the volume.
  const double sigma = largest_sigma_rad(three);
  const double widest = angle_rad(three[0].direction, three[2].direction);
  if (!(std::fabs(lines.d0) > std::max(1e-14, 3 * sigma * std::min(widest, sines / widest))))
    return Orbits::refused("the three lines of sight lie in one plane: ranges are not determined");
  std::vector<OrbitState> out;
  for (const double distance_m : distances(lines, lines.light_left_s[0], lines.light_left_s[2])) {
    OrbitState state;
    if (!improve(lines, distance_m, state)) continue;
    const double range_m = norm(state.position_m - three[1].sensor_m);
    state.time = three[1].time - sim_seconds(range_m / speed_of_light_m_per_s);
    if (within(limits, state)) add_distinct(out, state);
  }
  if (out.empty()) return Orbits::refused("no orbit near the Earth passes through the three lines");
  return out;
}

}  // namespace dmise
