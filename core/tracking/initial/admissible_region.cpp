#include "core/tracking/initial/admissible_region.h"

#include <Eigen/LU>
#include <cmath>

#include "core/base/units.h"
#include "core/orbit/two_body.h"

namespace dmise {

Outcome<Tracklet> tracklet_of(std::span<const AngleObservation> observations) {
  using Result = Outcome<Tracklet>;
  if (observations.size() < 2) return Result::refused("fewer than two observations");
  double mean_ns = 0;
  for (const AngleObservation& o : observations) {
    if (const auto fault = fault_of(o); !fault.empty()) return Result::refused(fault);
    if (o.sensor != observations[0].sensor)
      return Result::refused("the observations are of several sensors");
    mean_ns += double((o.time - observations[0].time).ns) / double(observations.size());
  }
  Tracklet out;
  out.time = observations[0].time + SimTime{std::llround(mean_ns)};
  double span_s = 0;
  for (const AngleObservation& o : observations)
    span_s = std::max(span_s, std::fabs((o.time - out.time).seconds()));
  if (!(span_s > 0)) return Result::refused("the observations are of one time");

  // Polynomials in time, of places on the sky about the mean direction's tangent, and of the
  // sensor's position: a line through two, else a parabola.
  Vec<Gcrs> centre{};
  for (const AngleObservation& o : observations) centre += o.direction;
  if (!(norm(centre) > 0.5 * double(observations.size())))
    return Result::refused("the arc is too long for a rate");
  centre = unit(centre);
  const SkyTangents tangents = sky_tangents(centre);
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Matrix<double, 3, 5> right = Eigen::Matrix<double, 3, 5>::Zero();
  for (const AngleObservation& o : observations) {
    const double t = (o.time - out.time).seconds() / span_s;
    const double depth = dot(o.direction, centre);
    if (!(depth > 0.1)) return Result::refused("the arc is too long for a rate");
    const double weight = 1 / std::max(o.covariance_rad2[0], o.covariance_rad2[2]);
    const Eigen::Vector3d powers{1, t, t * t};
    Eigen::Matrix<double, 1, 5> values;
    values << dot(o.direction, tangents.east) / depth, dot(o.direction, tangents.north) / depth,
        o.sensor_m.x, o.sensor_m.y, o.sensor_m.z;
    normal += weight * powers * powers.transpose();
    right += weight * powers * values;
  }
  Eigen::Matrix3d inverse = Eigen::Matrix3d::Zero();
  const Eigen::Matrix3d parabola = normal.inverse();
  if (observations.size() >= 3 && parabola.allFinite() &&
      normal.determinant() > 1e-9 * std::pow(normal(0, 0), 3))
    inverse = parabola;
  else
    inverse.topLeftCorner<2, 2>() = normal.topLeftCorner<2, 2>().inverse();
  const Eigen::Matrix<double, 3, 5> fit = inverse * right;
  if (!fit.allFinite() || !inverse.allFinite())
    return Result::refused("the observations do not determine a rate");
  const Eigen::Vector3d place =
      eigen_of(centre) + fit(0, 0) * eigen_of(tangents.east) + fit(0, 1) * eigen_of(tangents.north);
  const Eigen::Vector3d rate =
      (fit(1, 0) * eigen_of(tangents.east) + fit(1, 1) * eigen_of(tangents.north)) / span_s;
  const Eigen::Vector3d direction = place.normalized();
  out.direction = gcrs_of(direction);
  out.rate_rad_per_s = gcrs_of((rate - direction * direction.dot(rate)) / place.norm());
  out.sensor_m = gcrs_of(fit.row(0).tail<3>().transpose());
  out.sensor_m_per_s = gcrs_of(fit.row(1).tail<3>().transpose() / span_s);
  return out;
}

RangeRates bound_range_rates(const Tracklet& tracklet, double range_m) {
  // |v|^2 = rate^2 + 2 rate (sensor velocity . direction) + |sensor velocity + range turn|^2.
  const Vec<Gcrs> place = tracklet.sensor_m + range_m * tracklet.direction;
  const Vec<Gcrs> across = tracklet.sensor_m_per_s + range_m * tracklet.rate_rad_per_s;
  const double b = dot(tracklet.sensor_m_per_s, tracklet.direction);
  const double c = dot(across, across) - 2 * earth_gm_m3_per_s2 / norm(place);
  const double root2 = b * b - c;
  if (!(root2 > 0)) return {};
  return {-b - std::sqrt(root2), -b + std::sqrt(root2)};
}

Outcome<std::vector<OrbitState>> admissible_region(const Tracklet& tracklet,
                                                   const AdmissibleSettings& settings) {
  using Result = Outcome<std::vector<OrbitState>>;
  if (!(settings.min_range_m > 0) || !(settings.largest_range_m > settings.min_range_m) ||
      !(settings.largest_range_m < 1e12) || settings.ranges < 2 || settings.range_rates < 2)
    return Result::refused("ranges must rise from above 0, with two samples at least");
  std::vector<OrbitState> out;
  const double step =
      std::log(settings.largest_range_m / settings.min_range_m) / (settings.ranges - 1);
  for (int i = 0; i < settings.ranges; ++i) {
    const double range_m = settings.min_range_m * std::exp(i * step);
    const RangeRates bounds = bound_range_rates(tracklet, range_m);
    if (bounds.empty()) continue;
    for (int k = 0; k < settings.range_rates; ++k) {
      const double share = (k + 0.5) / settings.range_rates;
      const double rate =
          bounds.min_m_per_s + share * (bounds.largest_m_per_s - bounds.min_m_per_s);
      const OrbitState state{
          tracklet.time - sim_seconds(range_m / speed_of_light_m_per_s),
          tracklet.sensor_m + range_m * tracklet.direction,
          tracklet.sensor_m_per_s + rate * tracklet.direction + range_m * tracklet.rate_rad_per_s};
      if (within(settings.limits, state)) out.push_back(state);
    }
  }
  if (out.empty())
    return Result::refused("no range and range rate make a bound orbit above the air");
  return out;
}

}  // namespace dmise
