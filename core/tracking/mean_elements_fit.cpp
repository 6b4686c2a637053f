#include "core/tracking/mean_elements_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "core/base/units.h"
#include "core/frames/earth_orientation.h"
#include "core/orbit/sgp4/sgp4_batch.h"
#include "core/tracking/propagate.h"

namespace dmise {
namespace {

constexpr int places = 25, unknowns = 6, max_rounds = 40;
constexpr double longest_arc_s = 86400.0;
constexpr double drag_of_bstar_m2_per_kg = 12.741621;

// Mean motion [rad/min], e cos and e sin of the longitude of perigee, tan(i/2) cos and sin of the
// node, mean longitude: smooth at circles and at the equator, not for an orbit that turns back.
using Unknowns = Eigen::Matrix<double, unknowns, 1>;
using Rows = Eigen::Matrix<double, 3 * places, 1>;

MeanElements elements_of(const Unknowns& x, MeanElements rest) {
  const double node = std::atan2(x[4], x[3]), perigee = std::atan2(x[2], x[1]);
  const auto turn = [](double angle) { return angle - 2.0 * pi * std::floor(angle / (2.0 * pi)); };
  rest.mean_motion_rad_per_min = x[0];
  rest.eccentricity = std::hypot(x[1], x[2]);
  rest.inclination_rad = 2.0 * std::atan(std::hypot(x[3], x[4]));
  rest.raan_rad = turn(node);
  rest.argument_of_perigee_rad = turn(perigee - node);
  rest.mean_anomaly_rad = turn(x[5] - perigee);
  return rest;
}

/// Osculating elements in TEME, from where the fit starts.
Unknowns osculating(const Vec<Teme>& r, const Vec<Teme>& v) {
  const double distance = norm(r), mu = earth_gm_m3_per_s2;
  const double a = 1.0 / (2.0 / distance - dot(v, v) / mu);
  const Vec<Teme> h = cross(r, v), pole = h / norm(h);
  const Vec<Teme> e = cross(v, h) / mu - r / distance;
  const double share = 1.0 + pole.z;                     // 2 cos^2 (i / 2)
  const double p = -pole.y / share, q = pole.x / share;  // tan(i/2) cos and sin of the node
  // Axes of the equinoctial frame (Vallado, 2-98).
  const double scale = 1.0 / (1.0 + p * p + q * q);
  const Vec<Teme> f = Vec<Teme>{1.0 + p * p - q * q, 2.0 * p * q, -2.0 * q} * scale;
  const Vec<Teme> g = Vec<Teme>{2.0 * p * q, 1.0 - p * p + q * q, 2.0 * p} * scale;
  const double ec = dot(e, f), es = dot(e, g), eccentricity = std::hypot(ec, es);
  const double true_longitude = std::atan2(dot(r, g), dot(r, f)), perigee = std::atan2(es, ec);
  const double anomaly = true_longitude - perigee;
  const double root = std::sqrt((1.0 - eccentricity) / (1.0 + eccentricity));
  const double eccentric =
      2.0 * std::atan2(root * std::sin(0.5 * anomaly), std::cos(0.5 * anomaly));
  Unknowns x;
  x << 60.0 * std::sqrt(mu / (a * a * a)), ec, es, p, q,
      perigee + eccentric - eccentricity * std::sin(eccentric);
  return x;
}

class Fit {
 public:
  Fit(MeanElements rest, std::vector<double> minutes, const Rows& path_m)
      : rest_(std::move(rest)), minutes_(std::move(minutes)), path_m_(path_m) {}

  MeanElements elements(const Unknowns& x) const { return elements_of(x, rest_); }

  /// Path of SGP4 less the path that it is to follow; none where SGP4 has none.
  std::optional<Rows> residuals_m(const Unknowns& x) const {
    if (!(x[0] > 0.0) || !(std::hypot(x[1], x[2]) < 1.0)) return std::nullopt;
    const MeanElements set = elements(x);
    const Sgp4Batch batch(std::span(&set, 1));
    std::array<double, 3 * places> at{}, velocity{};
    std::array<std::uint8_t, places> code{};
    batch.propagate_times(0, minutes_, at, velocity, code);
    if (std::ranges::any_of(code, [](auto c) { return c != 0; })) return std::nullopt;
    Rows rows;
    for (int k = 0; k < places; ++k)
      for (int axis = 0; axis < 3; ++axis)
        rows[3 * k + axis] = at[std::size_t(axis * places + k)] - path_m_[3 * k + axis];
    return rows;
  }

  std::optional<Eigen::Matrix<double, 3 * places, unknowns>> slopes(const Unknowns& x) const {
    Eigen::Matrix<double, 3 * places, unknowns> all;
    for (int i = 0; i < unknowns; ++i) {
      const double step = i == 0 ? 1e-6 * x[0] : 1e-6;
      Unknowns more = x, less = x;
      more[i] += step, less[i] -= step;
      const auto a = residuals_m(more), b = residuals_m(less);
      if (!a || !b) return std::nullopt;
      all.col(i) = (*a - *b) / (2.0 * step);
    }
    return all;
  }

 private:
  MeanElements rest_;
  std::vector<double> minutes_;
  Rows path_m_;
};

}  // namespace

Outcome<MeanElementsFit> fit_mean_elements(const Clock& clock, const ForceModel& forces,
                                           const OrbitState& state) {
  using Result = Outcome<MeanElementsFit>;
  if (!is_sane(state)) return Result::refused("the state is not finite or at the Earth's centre");
  if (!std::isfinite(apogee_m(state))) return Result::refused("the orbit is open");
  const double a = 0.5 * (perigee_m(state) + apogee_m(state));
  const double period_s = 2.0 * pi * std::sqrt(a * a * a / earth_gm_m3_per_s2);
  const double arc_s = std::min(period_s, longest_arc_s);
  const auto teme_from_gcrs = [&](SimTime t) {
    return earth_orientation(clock, t, Nutation::iau2000b).gcrs_from_teme(t).inverse();
  };
  std::vector<double> minutes;
  Rows path_m;
  for (int k = 0; k < places; ++k) {
    const SimTime time = state.time + sim_seconds(arc_s * (double(k) / (places - 1) - 0.5));
    const auto there = propagate(forces, state, time);
    if (!there) return Result::refused(there.reason);
    const Vec<Teme> at = teme_from_gcrs(time) * there->position_m;
    minutes.push_back((time - state.time).seconds() / 60.0);
    path_m[3 * k] = at.x, path_m[3 * k + 1] = at.y, path_m[3 * k + 2] = at.z;
  }
  const auto teme = teme_from_gcrs(state.time);
  const Vec<Teme> r = teme * state.position_m, v = teme * state.velocity_m_per_s;
  const Vec<Teme> h = cross(r, v);
  if (!(h.z > -0.9999 * norm(h)))
    return Result::refused("the orbit is retrograde within 0.8 deg of the equator");
  Unknowns x = osculating(r, v);
  const Utc epoch = clock.utc(state.time);
  const Fit fit({.epoch_jd1 = epoch.jd1,
                 .epoch_jd2 = epoch.jd2,
                 .bstar_per_earth_radius = state.drag_m2_per_kg / drag_of_bstar_m2_per_kg},
                std::move(minutes), path_m);
  auto rows = fit.residuals_m(x);
  if (!rows) return Result::refused("SGP4 has no path for such elements");
  double damping = 1e-6;
  for (int round = 0; round < max_rounds && damping < 1e6; ++round) {
    const auto slopes = fit.slopes(x);
    if (!slopes) return Result::refused("SGP4 has no path for such elements");
    Eigen::Matrix<double, unknowns, unknowns> normal = slopes->transpose() * *slopes;
    normal.diagonal() *= 1.0 + damping;
    const Unknowns next = x - normal.ldlt().solve(slopes->transpose() * *rows);
    const auto rows_there = fit.residuals_m(next);
    if (!rows_there || !(rows_there->squaredNorm() < rows->squaredNorm())) {
      damping = std::max(1e-3, 10.0 * damping);
      continue;
    }
    const bool settled = rows_there->squaredNorm() > (1.0 - 1e-9) * rows->squaredNorm();
    x = next, rows = rows_there, damping *= 0.1;
    if (settled) break;
  }
  double worst_m = 0.0;
  for (int k = 0; k < places; ++k) worst_m = std::max(worst_m, rows->segment<3>(3 * k).norm());
  return MeanElementsFit{.elements = fit.elements(x),
                         .rms_m = std::sqrt(rows->squaredNorm() / places),
                         .worst_m = worst_m};
}

}  // namespace dmise
