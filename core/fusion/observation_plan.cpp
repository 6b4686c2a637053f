#include "core/fusion/observation_plan.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/fusion/sensor_frame.h"
#include "core/tracking/line_of_light.h"
#include "core/tracking/predict.h"
#include "core/tracking/propagate.h"

namespace dmise {
namespace {

const PropagationSettings propagation{.position_tolerance_m = 1e-2};
constexpr int max_turns = 12;              // rounds of the slew's time and where it leads
constexpr double settled_within_s = 1e-3;  // between two of them
constexpr double least_lit = 0.5;          // fraction of the Sun's disc
constexpr double path_step_s = 10.0;       // cubic: to 3 mm
constexpr double max_path_points = 1000;
constexpr std::string_view too_fast = "it is faster than the mount";

struct Place {
  Vec<Gcrs> sensor_m;
  Rotation<Enu, Gcrs> enu_from_gcrs;
};

Place place_of(const CueSky& sky, const CuedSensor& sensor, SimTime t) {
  const auto itrs_from_gcrs = sky.earth.itrs_from_gcrs(t);
  return {itrs_from_gcrs.inverse() * itrs_from_geodetic(sensor.site),
          enu_from_itrs(sensor.site) * itrs_from_gcrs};
}

/// Direction of light that arrives at `t` from a state at `t`.
Vec<Gcrs> line_to(const OrbitState& state, const Vec<Gcrs>& sensor_m) {
  const Vec<Gcrs> line = state.position_m - sensor_m;
  return line - state.velocity_m_per_s * (norm(line) / speed_of_light_m_per_s);
}

/// Why a sensor may not look at a state; empty if it may.
std::string_view obstacle_of(const CueSky& sky, const CueSettings& cue, const Place& place,
                             const OrbitState& state) {
  const Vec<Gcrs> line = line_to(state, place.sensor_m), direction = unit(line);
  const double height = (place.enu_from_gcrs * direction).z;
  if (height < std::sin(cue.min_elevation_deg * deg)) return "it is below the least elevation";
  if (cue.greatest_elevation_deg < 90 && height > std::sin(cue.greatest_elevation_deg * deg))
    return "it is above the greatest elevation";
  if (angle_rad(direction, sky.bodies.sun_m - place.sensor_m) < cue.sun_exclusion_deg * deg)
    return "it is too near the Sun";
  if (angle_rad(direction, sky.bodies.moon_m - place.sensor_m) < cue.moon_exclusion_deg * deg)
    return "it is too near the Moon";
  const Vec<Gcrs> across =
      state.velocity_m_per_s - direction * dot(state.velocity_m_per_s, direction);
  if (cue.mount == MountKind::great_circle && norm(across) / norm(line) > cue.slew_deg_per_s * deg)
    return too_fast;
  return sky.shadow.sunlit_fraction(state.position_m) >= least_lit ? ""
                                                                   : "it is in the Earth's shadow";
}

/// Derivatives of the angles east and north of a line with respect to the position.
Eigen::Matrix<double, 2, 3> angle_rows(const Vec<Gcrs>& line) {
  return rows_of(sky_tangents(unit(line))) / norm(line);
}

double chance(double magnitude_1000_km, double range_m, double limit, double best) {
  const SensorFrame frame{.limiting_magnitude = limit};
  return frame.detection_probability(magnitude_1000_km + 5 * std::log10(range_m / 1e6), best);
}

/// J = (H F)' R^-1 (H F) of the place at a time, F from the epoch.
Matrix6 information_at(const OrbitState& state, const Matrix6& transition,
                       const Vec<Gcrs>& sensor_m, double sigma_rad) {
  const Eigen::Matrix<double, 2, 6> rows =
      angle_rows(line_to(state, sensor_m)) * transition.topRows<3>() / sigma_rad;
  return rows.transpose() * rows;
}

}  // namespace

CueSky::CueSky(const Clock& clock, SimTime time, const Ellipsoid& ellipsoid)
    : earth(earth_orientation(clock, time)),
      bodies(solar_system(clock.tt(time))),
      shadow(bodies.sun_m, oblate_earth(earth, ellipsoid)) {}

double rough_rate(const CueSky& sky, const CuedSensor& sensor, const CueTarget& target,
                  const MountPosition& from, SimTime start) {
  const SimTime t = start + sim_seconds(sensor.cue.settle_s);
  const OrbitState& known = target.estimate.state;
  const double dt_s = (t - known.time).seconds();
  const Vec<Gcrs> r = position_after_m(known.position_m, known.velocity_m_per_s, dt_s);
  const Place place = place_of(sky, sensor, t);
  const Vec<Gcrs> line = r - place.sensor_m;
  const Vec<Enu> direction = place.enu_from_gcrs * unit(line);
  if (direction.z < 0) return 0.0;  // it may rise meanwhile
  const auto& p = target.estimate.covariance;
  const Eigen::Matrix3d spread = p.topLeftCorner<3, 3>() + dt_s * dt_s * p.block<3, 3>(3, 3);
  const Eigen::Matrix<double, 2, 3> rows = angle_rows(line) / (sensor.cue.sigma_arcsec * arcsec);
  const Eigen::Matrix2d seen = Eigen::Matrix2d::Identity() + rows * spread * rows.transpose();
  const auto ways = slews_to(sensor.cue, from, direction);
  if (ways.empty()) return 0.0;
  const double seconds = ways.front().seconds + sensor.cue.settle_s + sensor.cadence_s;
  return target.existence *
         chance(target.magnitude, norm(line), sensor.cue.limiting_magnitude, 1.0) * 0.5 *
         std::log(seen.determinant()) / seconds;
}

namespace {

/// A plan by one of the ways to the target, by their order; refused also if there are not so many.
Outcome<ObservationPlan> plan_by(std::size_t way, const ForceModel& forces, const CueSky& sky,
                                 const CuedSensor& sensor, const CueTarget& target,
                                 const MountPosition& from, SimTime start, SimTime last,
                                 double best_detection_probability) {
  const CueSettings& cue = sensor.cue;
  ObservationPlan plan{.start = start, .on_target = start + sim_seconds(cue.settle_s)};
  const auto refused = Outcome<ObservationPlan>::refused;
  const auto direction_of = [](const Place& place, const OrbitState& state) {
    return place.enu_from_gcrs * unit(line_to(state, place.sensor_m));
  };
  // Where the target is when the sensor has turned to it.
  OrbitState state = target.estimate.state;
  MountPosition mount;
  bool settled = false;
  for (int turn = 0; turn < max_turns && !settled; ++turn) {
    const auto moved = propagate(forces, state, plan.on_target, propagation);
    if (!moved) return refused(moved.reason);
    state = *moved;
    const auto ways =
        slews_to(cue, from, direction_of(place_of(sky, sensor, plan.on_target), state));
    if (ways.size() <= way) return refused("it is out of the mount's reach");
    mount = ways[way].to;
    plan.slew_rad = ways[way].angle_rad;
    plan.slew_s = ways[way].seconds + cue.settle_s;
    const SimTime ready = start + sim_seconds(plan.slew_s);
    settled = (ready - plan.on_target).seconds() < settled_within_s;
    plan.on_target = std::max(plan.on_target, ready);
  }
  if (!settled) return refused(too_fast);  // or about as fast
  plan.first_frame = sensor.first_frame_from(plan.on_target);
  const SimTime exposure = sim_seconds(sensor.exposure_s), half{exposure.ns / 2};

  auto at = propagate(forces, target.estimate, plan.on_target, propagation);
  if (!at) return refused(at.reason);
  if (!is_sane(*at)) return refused("its path can't be predicted");
  plan.at = *at;
  Matrix6 transition = Matrix6::Identity();
  OrbitState seen = target.estimate.state;
  SimTime followed_to = plan.on_target;
  std::string_view obstacle = "the run ends before";
  for (int n = 0; n < cue.exposures; ++n) {
    const SimTime begins = sensor.exposure_start(plan.first_frame + std::uint32_t(n));
    if (begins + exposure > last) break;
    const auto step = propagate_with_transition(forces, seen, begins + half, propagation);
    obstacle = step.reason;
    if (!step) break;
    const Place place = place_of(sky, sensor, begins + half);
    obstacle = obstacle_of(sky, cue, place, step->state);
    if (!obstacle.empty()) break;
    const Vec<Enu> direction = direction_of(place, step->state);
    // Begin and end of the exposure tell how fast the axes turn in it.
    std::optional<MountPosition> follows = mount;
    for (const SimTime t : {begins, begins + half, begins + exposure}) {
      if (cue.mount == MountKind::great_circle) break;
      OrbitState there = step->state;
      there.position_m = there.position_m + there.velocity_m_per_s * (t - begins - half).seconds();
      const double seconds = std::max(0.0, (t - followed_to).seconds());
      follows = followed(cue, *follows, direction_of(place_of(sky, sensor, t), there), seconds);
      if (!follows) break;
      followed_to = t;
    }
    obstacle = too_fast;  // or beyond the range of its azimuth
    if (!follows) break;
    mount = *follows;
    seen = step->state;
    transition = step->transition.topLeftCorner<6, 6>() * transition;
    plan.information += information_at(seen, transition, place.sensor_m, cue.sigma_arcsec * arcsec);
    plan.at_end = {direction, mount.azimuth_rad};
    plan.end = begins + exposure;
    ++plan.exposures;
    if (n > 0) continue;
    const Eigen::Matrix<double, 2, 6> rows =
        angle_rows(line_to(seen, place.sensor_m)) * transition.topRows<3>();
    const Eigen::Matrix2d spread =
        rows * target.estimate.covariance.topLeftCorner<6, 6>() * rows.transpose();
    plan.sigma_rad = std::sqrt(std::max(
        0.0, spread.trace() / 2 + std::sqrt(std::max(0.0, spread.trace() * spread.trace() / 4 -
                                                              spread.determinant()))));
    plan.in_field = probability_in_circle(spread, sensor.half_angle_rad);
    plan.detection_probability =
        plan.in_field * chance(target.magnitude, norm(line_to(seen, place.sensor_m)),
                               cue.limiting_magnitude, best_detection_probability);
  }
  if (plan.exposures == 0) return refused(obstacle);
  return plan;
}

}  // namespace

Outcome<ObservationPlan> plan_observation(const ForceModel& forces, const CueSky& sky,
                                          const CuedSensor& sensor, const CueTarget& target,
                                          const MountPosition& from, SimTime start, SimTime last,
                                          double best_detection_probability) {
  const auto by = [&](std::size_t way) {
    return plan_by(way, forces, sky, sensor, target, from, start, last, best_detection_probability);
  };
  auto plan = by(0);
  if (plan || sensor.cue.mount == MountKind::great_circle) return plan;
  auto other = by(1);  // if the faster way leads to a limit of the axes
  return other ? other : plan;
}

Matrix6 information_of(const ForceModel& forces, const CueSky& sky, const CuedSensor& sensor,
                       const Task& task, const OrbitEstimate& estimate) {
  Matrix6 sum = Matrix6::Zero(), transition = Matrix6::Identity();
  OrbitState seen = estimate.state;
  const SimTime half{sim_seconds(sensor.exposure_s).ns / 2};
  for (std::uint32_t n = 0; n < task.exposures; ++n) {
    const SimTime middle = sensor.exposure_start(task.first_frame + n) + half;
    const auto step = propagate_with_transition(forces, seen, middle, propagation);
    if (!step) return Matrix6::Zero();
    seen = step->state;
    transition = step->transition.topLeftCorner<6, 6>() * transition;
    sum += information_at(seen, transition, place_of(sky, sensor, middle).sensor_m,
                          sensor.cue.sigma_arcsec * arcsec);
  }
  return sum * task.detection_probability;
}

double gain_nats(const OrbitEstimate& estimate, const Matrix6& known, const Matrix6& added) {
  const Matrix6 covariance = estimate.covariance.topLeftCorner<6, 6>();
  const Eigen::LLT<Matrix6> root(covariance);
  if (root.info() != Eigen::Success) return 0.0;
  const Matrix6 l = root.matrixL();
  const auto log_det = [&](const Matrix6& information) {
    const Matrix6 inner = Matrix6::Identity() + l.transpose() * information * l;
    const Eigen::LLT<Matrix6> factor(inner);
    if (factor.info() != Eigen::Success) return 0.0;
    double sum = 0;
    for (int i = 0; i < 6; ++i) sum += std::log(Matrix6(factor.matrixL())(i, i));
    return sum;  // half of that of the product
  };
  const double gain = log_det(known + added) - log_det(known);
  return std::isfinite(gain) ? std::max(0.0, gain) : 0.0;
}

void put_path(const ForceModel& forces, const OrbitState& state, SimTime from, SimTime to,
              Task& task) {
  task.path_step_s = std::max(path_step_s, (to - from).seconds() / max_path_points);
  task.path_start = from;
  OrbitState point = state;
  for (SimTime t = from;; t = t + sim_seconds(task.path_step_s)) {
    const auto moved = propagate(forces, point, t, propagation);
    if (!moved) break;  // the path ends in the Earth: it is cut there
    point = *moved;
    const Vec<Gcrs>&r = point.position_m, &v = point.velocity_m_per_s;
    task.path_m.insert(task.path_m.end(), {r.x, r.y, r.z});
    task.path_m_per_s.insert(task.path_m_per_s.end(), {v.x, v.y, v.z});
    if (t >= to) break;
  }
}

}  // namespace dmise
