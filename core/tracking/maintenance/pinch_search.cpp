#include "core/tracking/maintenance/pinch_search.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/numeric/chi_square.h"
#include "core/tracking/maintenance/arc_fit.h"

namespace dmise {
namespace {

constexpr double grid_s = 60.0;
constexpr long places_of_sigma = 60;  // neighbours with one deviation
constexpr double chord_m = 100.0;     // by which differences of places are not linear in a step
constexpr double pinch_gate = 4.0;
constexpr double worst_fit = 3.5;  // normal deviate of chi-square, above which a member is dropped
constexpr int max_pinch_steps = 6;
constexpr double pinch_done_s = 1e-3;
constexpr double shell_m = 4e5;  // thickness of a shell of orbits
constexpr double usual_speed_m_per_s = 7e3;
constexpr double same_time_s = 120.0;  // between points that are one

/// The place of an object near a time, with its errors.
struct Passing {
  Eigen::Vector3d position_m, velocity_m_per_s;
  Eigen::Matrix3d weight, covariance;
};

/// Place and time of one point on all paths, to first order: x in the first rows, then the time.
struct Crossing {
  Eigen::Vector4d at;
  Eigen::Matrix4d covariance;
};

Crossing crossing_of(const std::vector<Passing>& all) {
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  Eigen::Vector4d right = Eigen::Vector4d::Zero();
  const Eigen::Vector3d about = all.front().position_m;
  for (const Passing& p : all) {
    Eigen::Matrix<double, 3, 4> g;
    g << Eigen::Matrix3d::Identity(), -p.velocity_m_per_s;
    normal += g.transpose() * p.weight * g;
    right += g.transpose() * p.weight * (p.position_m - about);
  }
  const Eigen::LDLT<Eigen::Matrix4d> root(normal);
  Crossing out{root.solve(right), root.solve(Eigen::Matrix4d::Identity())};
  out.at.head<3>() += about;
  return out;
}

double d2_of(const Passing& p, const Crossing& c) {
  const Eigen::Vector3d off = p.position_m + c.at[3] * p.velocity_m_per_s - c.at.head<3>();
  return off.dot(p.weight * off);
}

/// By how much a place may lie off the line along which an uncertain time moves it: second moment
/// of half the Earth's attraction times the square of the time.
Eigen::Matrix3d bend_of(const Eigen::Vector3d& position_m, double sigma_s) {
  const double a = earth_gm_m3_per_s2 / position_m.squaredNorm();
  const Eigen::Vector3d by = a * sigma_s * sigma_s * position_m.normalized();
  return 0.75 * by * by.transpose();
}

double log_choose(double n, double k) {
  return std::lgamma(n + 1) - std::lgamma(k + 1) - std::lgamma(n - k + 1);
}

}  // namespace

PinchSearch::PinchSearch(const MaintenanceForces& forces, SimTime first,
                         const PinchSettings& settings)
    : forces_(&forces), first_(first), settings_(settings) {}

void PinchSearch::put(std::size_t object, const OrbitEstimate& first_seen) {
  const SimTime seen = first_seen.state.time;
  if (const auto known = pasts_.find(object); known != pasts_.end()) {
    if (known->second.path.start() < seen) return;
    pasts_.erase(known);
  }
  const SimTime back = std::max(first_, seen - sim_seconds(settings_.back_s));
  if (!(back < seen)) return;
  auto path = ArcPath::fly(*forces_, first_seen.state, {}, back);
  if (!path) return;
  Past past{.path = std::move(*path), .covariance = first_seen.covariance};
  const long last = long(std::floor(seen.seconds() / grid_s));
  const long earliest = long(std::ceil(back.seconds() / grid_s));
  double sigma_m = 0.0;
  for (long k = last; k >= earliest; --k) {
    const SimTime time = sim_seconds(double(k) * grid_s);
    if ((last - k) % places_of_sigma == 0) {
      const long end = std::max(k - places_of_sigma + 1, earliest);
      const OrbitEstimate then =
          moved_along(*forces_, past.path, past.covariance, sim_seconds(double(end) * grid_s));
      sigma_m = std::sqrt(then.covariance.topLeftCorner<3, 3>().trace());
      if (!(sigma_m < settings_.max_sigma_m)) break;
    }
    past.places.push_back(past.path.at(time).position_m);
    past.sigmas.push_back(sigma_m);
    past.first = k;
  }
  std::ranges::reverse(past.places);
  std::ranges::reverse(past.sigmas);
  if (past.places.size() > 1) pasts_.emplace(object, std::move(past));
}

std::vector<PinchSearch::Meeting> PinchSearch::meetings(const Past& past,
                                                        std::size_t object) const {
  std::vector<Meeting> out;
  for (const auto& [other, there] : pasts_) {
    if (other == object) continue;
    const long first = std::max(past.first, there.first);
    const long end =
        std::min(past.first + long(past.places.size()), there.first + long(there.places.size()));
    const auto apart = [&](long k) {
      return past.places[std::size_t(k - past.first)] - there.places[std::size_t(k - there.first)];
    };
    for (long k = first; k + 1 < end; ++k) {
      const Vec<Gcrs> from = apart(k);
      const double reach_m = settings_.max_apart_m_per_s * grid_s;
      const double sigma_m =
          past.sigmas[std::size_t(k - past.first)] + there.sigmas[std::size_t(k - there.first)];
      if (dot(from, from) > (reach_m + pinch_gate * sigma_m) * (reach_m + pinch_gate * sigma_m))
        continue;
      const Vec<Gcrs> by = apart(k + 1) - from;
      const double speed2 = dot(by, by);
      if (speed2 > reach_m * reach_m || !(speed2 > 0)) continue;
      // Half a step beyond either end, since neighbours may disagree about an edge.
      const double share = -dot(from, by) / speed2;
      if (share < -0.5 || share > 1.5 || norm(from + share * by) > pinch_gate * sigma_m + chord_m)
        continue;
      const double time_s = (double(k) + std::clamp(share, 0.0, 1.0)) * grid_s;
      if (out.empty() || out.back().other != other || time_s - out.back().time_s > same_time_s)
        out.push_back({other, time_s});
    }
  }
  return out;
}

/// Objects whose place is that of another at a time, within both's errors.
std::vector<std::size_t> PinchSearch::near(const Past& past, double time_s) const {
  const long k = long(std::floor(time_s / grid_s));
  const double share = time_s / grid_s - double(k);
  const auto at = [&](const Past& p) -> std::optional<std::pair<Vec<Gcrs>, double>> {
    const long i = k - p.first;
    if (i < 0 || i + 1 >= long(p.places.size())) return std::nullopt;
    const Vec<Gcrs>&a = p.places[std::size_t(i)], &b = p.places[std::size_t(i) + 1];
    return std::pair(a + share * (b - a), p.sigmas[std::size_t(i)]);
  };
  std::vector<std::size_t> out;
  const auto here = at(past);
  if (!here) return out;
  for (const auto& [other, there] : pasts_) {
    const auto place = at(there);
    // Within a step of the grid a chord is off by kilometres, alike for all that are close; what
    // moves differently meets at another share of the step.
    const double slack_m = 0.1 * settings_.max_apart_m_per_s * grid_s;
    if (place &&
        norm(place->first - here->first) < pinch_gate * (place->second + here->second) + slack_m)
      out.push_back(other);
  }
  return out;
}

std::optional<PinchPoint> PinchSearch::solved(std::vector<std::size_t> members,
                                              SimTime time) const {
  const auto reaches = [&](std::size_t m) {
    const Past& p = pasts_.at(m);
    return sim_seconds(double(p.first) * grid_s) <= time && time <= p.path.start();
  };
  for (int count = 0; members.size() >= settings_.min_members; ++count) {
    std::erase_if(members, [&](std::size_t m) { return !reaches(m); });
    if (members.size() < settings_.min_members) return std::nullopt;
    std::vector<Passing> all;
    for (const std::size_t m : members) {
      const Past& p = pasts_.at(m);
      const OrbitEstimate then = moved_along(*forces_, p.path, p.covariance, time);
      const Eigen::Matrix3d covariance = then.covariance.topLeftCorner<3, 3>();
      all.push_back({eigen_of(then.state.position_m), eigen_of(then.state.velocity_m_per_s),
                     covariance.inverse(), covariance});
    }
    const Crossing crossing = crossing_of(all);
    if (!crossing.at.allFinite()) return std::nullopt;
    std::vector<double> d2;
    double chi_square = 0;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const Passing& p : all) {
      d2.push_back(d2_of(p, crossing));
      chi_square += d2.back();
      mean += p.velocity_m_per_s / double(all.size());
    }
    const int degrees = int(3 * all.size()) - 4;
    const auto fastest = std::ranges::max_element(
        all, {}, [&](const Passing& p) { return (p.velocity_m_per_s - mean).norm(); });
    const double sigma_s = std::sqrt(crossing.covariance(3, 3));
    if (const bool fits = normal_of_chi_square(chi_square, degrees) < worst_fit;
        !fits || (fastest->velocity_m_per_s - mean).norm() > settings_.max_apart_m_per_s) {
      const auto worst = fits ? fastest - all.begin() : std::ranges::max_element(d2) - d2.begin();
      members.erase(members.begin() + worst);
      continue;
    }
    if (!(sigma_s < settings_.max_time_sigma_s)) return std::nullopt;
    if (std::fabs(crossing.at[3]) > pinch_done_s && count < max_pinch_steps + int(members.size())) {
      time = time + sim_seconds(std::clamp(crossing.at[3], -grid_s, grid_s));
      continue;
    }
    return PinchPoint{.time = time,
                      .time_sigma_s = sigma_s,
                      .position_m = gcrs_of(crossing.at.head<3>()),
                      .covariance = crossing.covariance.topLeftCorner<3, 3>() +
                                    bend_of(crossing.at.head<3>(), sigma_s),
                      .velocity_m_per_s = gcrs_of(mean),
                      .members = std::move(members),
                      .chi_square = chi_square,
                      .degrees = degrees};
  }
  return std::nullopt;
}

/// How many such points unrelated objects make: each other member is by chance within the gate, in
/// a shell of orbits, at any of the times that differ.
double PinchSearch::expected_by_chance(const PinchPoint& point) const {
  double log_volume = 0;
  for (const std::size_t m : point.members) {
    const Past& p = pasts_.at(m);
    const OrbitEstimate then = moved_along(*forces_, p.path, p.covariance, point.time);
    log_volume += 0.5 * std::log(then.covariance.topLeftCorner<3, 3>().determinant()) /
                  double(point.members.size());
  }
  const double gate_m = pinch_gate * std::exp(log_volume / 3);
  const double r = norm(point.position_m), n = double(point.members.size());
  const double share = gate_m * gate_m * gate_m / (3 * r * r * shell_m);
  const double times = 1 + settings_.back_s * usual_speed_m_per_s / (2 * gate_m);
  return std::exp(log_choose(double(pasts_.size()), n) + (n - 1) * std::log(share)) * times;
}

std::optional<PinchPoint> PinchSearch::of(std::size_t object) const {
  const auto own = pasts_.find(object);
  if (own == pasts_.end()) return std::nullopt;
  std::vector<PinchPoint> points;
  const auto is_known = [&](double time_s) {
    return std::ranges::any_of(points, [&](const PinchPoint& p) {
      return std::fabs(p.time.seconds() - time_s) < same_time_s + p.time_sigma_s;
    });
  };
  for (const Meeting& meeting : meetings(own->second, object)) {
    if (is_known(meeting.time_s)) continue;
    auto members = near(own->second, meeting.time_s);
    if (members.size() < settings_.min_members) continue;
    auto point = solved(std::move(members), sim_seconds(meeting.time_s));
    if (point && std::ranges::binary_search(point->members, object) &&
        !is_known(point->time.seconds()))
      points.push_back(std::move(*point));
  }
  if (points.empty()) return std::nullopt;
  const auto best = std::ranges::max_element(points, [](const PinchPoint& a, const PinchPoint& b) {
    return a.members.size() != b.members.size() ? a.members.size() < b.members.size()
                                                : a.chi_square > b.chi_square;
  });
  double others = 0;
  for (const PinchPoint& p : points)
    if (p.members.size() == best->members.size())
      others += std::exp(0.5 * (best->chi_square - p.chi_square));
  best->confidence = std::exp(-expected_by_chance(*best)) / others;
  if (best->confidence < settings_.min_confidence) return std::nullopt;
  return *best;
}

}  // namespace dmise
