#include "core/forces/numerical_flight.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/forces/cubic.h"
#include "core/forces/dop853.h"
#include "core/frames/oblate_earth.h"

namespace dmise {
namespace {

constexpr int knots_of_polynomial = 6;  // Hermite, degree 11
constexpr double longest_turn =
    0.35;  // longest step in units of sqrt(r^3 / gm): polynomials are good to 1e-6 m
constexpr double shortest_step_s = 1e-6;
constexpr int max_steps = 5'000'000;
constexpr double beyond_edge_s = 1e-3;  // a step ends that far beyond the edge of a shadow

/// Position at share `u` of a step, by the cubic through both ends.
Vec<Gcrs> within_step(const FlightPoint& a, const FlightPoint& b, double u) {
  return cubic_between(a.state.position_m, a.state.velocity_m_per_s, b.state.position_m,
                       b.state.velocity_m_per_s, b.time_s - a.time_s, u);
}

/// Integrates one piece without a jump.
class Piece {
 public:
  Piece(const FlightForces& forces, const NumericalFlightSettings& settings, const Manoeuvre* burn)
      : forces_(forces), settings_(settings), burn_(burn) {}

  /// Moves `point` to `to_s`; `nodes`, if not null, gets the ends of steps, without the first.
  /// Returns why it stops before, with `point` at the last place.
  std::optional<FlightEnd> fly(FlightPoint& point, double to_s, std::vector<FlightPoint>* nodes) {
    const double sense = to_s < point.time_s ? -1 : 1;
    point.acceleration_m_per_s2 = acceleration(point.time_s, point.state);
    // A short piece gets the knots of a polynomial, too, unless a cubic is good to 0.1 mm: knots
    // that are close cost digits.
    const double whole_s = std::fabs(to_s - point.time_s);
    const double longest_s =
        whole_s < 0.006 * turn_s(point) ? whole_s : whole_s / (knots_of_polynomial + 1);
    double length_s = std::min(longest_s, 0.05 * turn_s(point));
    for (int count = 0; sense * (to_s - point.time_s) > 0; ++count) {
      if (count == max_steps) return FlightEnd{point.time_s, "it takes too many steps"};
      length_s = std::min({length_s, longest_s, longest_turn * turn_s(point)});
      const double left_s = std::fabs(to_s - point.time_s);
      const bool last = length_s >= left_s * (1 - 1e-9);
      if (!last) length_s = std::min(length_s, 0.5 * left_s);  // the last is not short
      FlightStep step = dop853_step(*this, point, sense * (last ? left_s : length_s));
      if (last) step.end.time_s = to_s;
      const double used_s = last ? left_s : length_s;
      const double factor =
          0.9 * std::pow(settings_.position_tolerance_m / (step.error_m + 1e-300), 0.125);
      if (!std::isfinite(step.error_m) || step.error_m > settings_.position_tolerance_m) {
        if (used_s < shortest_step_s) return FlightEnd{point.time_s, "it cannot be integrated"};
        length_s = used_s * (std::isfinite(step.error_m) ? std::clamp(factor, 0.1, 0.9) : 0.1);
        continue;
      }
      const double edge_s = to_edge_of_light_s(point, step.end);
      if (edge_s > 0 && edge_s < used_s) {
        point = dop853_step(*this, point, sense * edge_s).end;
        length_s = used_s - edge_s;
        continue;  // no node: what bends there is too little to see, and nodes may not be close
      }
      if (enters_earth(point, step.end)) {
        step.end = at_ground(point, step.end.time_s - point.time_s);
        point = step.end;
        if (nodes) add_last(point, *nodes);
        return FlightEnd{point.time_s, "it enters the Earth"};
      }
      point = step.end;
      if (nodes) nodes->push_back(point);
      if (!last || factor < 1) length_s = used_s * std::clamp(factor, 0.5, 2.0);
    }
    return std::nullopt;
  }

  Vec<Gcrs> operator()(double time_s, const Vec<Gcrs>& r_m, const Vec<Gcrs>& v_m_per_s) const {
    const Vec<Gcrs> a = forces_.acceleration_m_per_s2(time_s, r_m, v_m_per_s);
    if (!burn_) return a;
    return a + gcrs_from_rtn({r_m, v_m_per_s}, burn_->direction * burn_m_per_s2(*burn_, time_s));
  }

  bool below_ground(double time_s, const Vec<Gcrs>& r_m) const {
    const double highest_m = settings_.ellipsoid.equatorial_radius_m;
    if (dot(r_m, r_m) > highest_m * highest_m) return false;
    const OblateEarth earth{forces_.surroundings().at(time_s).pole, settings_.ellipsoid};
    return !(norm(earth.stretched(r_m)) > highest_m);
  }

 private:
  static double turn_s(const FlightPoint& point) {
    const double r = norm(point.state.position_m);
    return std::sqrt(r * r * r / earth_gm_m3_per_s2);
  }

  Vec<Gcrs> acceleration(double time_s, const MotionState<Gcrs>& state) const {
    return (*this)(time_s, state.position_m, state.velocity_m_per_s);
  }

  /// Time from the start of a step to the first change of sunlight in it; 0: there is none.
  double to_edge_of_light_s(const FlightPoint& a, const FlightPoint& b) const {
    const auto light = [&](double u) {
      return forces_.sunlight(a.time_s + u * (b.time_s - a.time_s), within_step(a, b, u));
    };
    const auto first = light(0);
    if (first == FlightForces::Sunlight::not_felt) return 0.0;
    constexpr int parts = 4;
    const double length_s = std::fabs(b.time_s - a.time_s);
    for (int i = 1; i <= parts; ++i) {
      if (light(double(i) / parts) == first) continue;
      double same = double(i - 1) / parts, other = double(i) / parts;
      while ((other - same) * length_s > 0.1 * beyond_edge_s) {
        const double middle = 0.5 * (same + other);
        (light(middle) == first ? same : other) = middle;
      }
      return other * length_s + beyond_edge_s;
    }
    return 0.0;
  }

  /// Whether a step of at most a third of a radian touches the ground.
  bool enters_earth(const FlightPoint& a, const FlightPoint& b) const {
    const double near_m = settings_.ellipsoid.equatorial_radius_m * 1.1;
    const double nearest_m = std::min(norm(a.state.position_m), norm(b.state.position_m));
    if (nearest_m > near_m) return false;
    if (below_ground(b.time_s, b.state.position_m)) return true;
    constexpr int parts = 16;
    const double h_s = b.time_s - a.time_s;
    for (int i = 1; i < parts; ++i) {
      const double u = double(i) / parts;
      if (below_ground(a.time_s + u * h_s, within_step(a, b, u))) return true;
    }
    return false;
  }

  /// Adds the end of a path, in place of a node that is close to it.
  static void add_last(const FlightPoint& point, std::vector<FlightPoint>& nodes) {
    const std::size_t n = nodes.size();
    const auto apart_s = [&](std::size_t i) { return std::fabs(point.time_s - nodes[i].time_s); };
    if (n > 2 && apart_s(n - 1) < 0.05 * apart_s(n - 2)) nodes.pop_back();
    nodes.push_back(point);
  }

  /// The last place above the ground on the way from `a`, to a microsecond.
  FlightPoint at_ground(const FlightPoint& a, double h_s) const {
    double above_s = 0.0, below_s = h_s;
    FlightPoint place = a;
    while (std::fabs(below_s - above_s) > 1e-6) {
      const double middle_s = 0.5 * (above_s + below_s);
      const FlightStep step = dop853_step(*this, a, middle_s);
      if (enters_earth(a, step.end)) {
        below_s = middle_s;
      } else {
        above_s = middle_s;
        place = step.end;
      }
    }
    return place;
  }

  const FlightForces& forces_;
  const NumericalFlightSettings& settings_;
  const Manoeuvre* burn_;
};

OemSegment segment_of(const std::vector<FlightPoint>& nodes) {
  OemSegment segment{.frame = OemFrame::gcrs,
                     .interpolation = OemInterpolation::hermite,
                     .degree = 2 * knots_of_polynomial - 1,
                     .usable_start_s = nodes.front().time_s,
                     .usable_stop_s = nodes.back().time_s};
  for (const FlightPoint& node : nodes) {
    const auto& [r, v] = node.state;
    segment.time_s.push_back(node.time_s);
    segment.position_m.push_back({r.x, r.y, r.z});
    segment.velocity_m_per_s.push_back({v.x, v.y, v.z});
  }
  return segment;
}

/// The way of one object from its epoch, piece by piece.
class Way {
 public:
  Way(const FlightForces& forces, const NumericalFlight& flight,
      const NumericalFlightSettings& settings)
      : forces_(forces), flight_(flight), settings_(settings) {}

  NumericalPath take() {
    const FlightPoint start{flight_.epoch_s, flight_.state, {}};
    const double first_s = std::clamp(flight_.epoch_s, flight_.from_s, flight_.to_s);
    if (Piece(forces_, settings_, nullptr).below_ground(start.time_s, start.state.position_m)) {
      path_.ends.push_back({start.time_s, "it starts within the Earth"});
      return std::move(path_);
    }
    FlightPoint point = start;
    if (flight_.epoch_s > flight_.from_s && !back(point, first_s)) return std::move(path_);
    if (flight_.epoch_s < flight_.to_s) on(start);
    return std::move(path_);
  }

 private:
  /// Flies back to `from_s`; whether it covers `first_s`. Leaves the nodes for the way on.
  bool back(FlightPoint point, double first_s) {
    Piece piece(forces_, settings_, nullptr);
    if (auto end = piece.fly(point, first_s, nullptr)) {
      path_.ends.push_back(*end);
      return false;
    }
    nodes_.push_back(point);
    if (auto end = piece.fly(point, flight_.from_s, &nodes_)) path_.ends.push_back(*end);
    std::reverse(nodes_.begin(), nodes_.end());
    if (flight_.epoch_s >= flight_.to_s) keep();
    return true;
  }

  void on(FlightPoint point) {
    if (nodes_.empty() && flight_.epoch_s >= flight_.from_s) nodes_.push_back(point);
    for (const Manoeuvre& manoeuvre : flight_.manoeuvres) {
      if (manoeuvre.at_s >= flight_.to_s) break;
      if (!to(point, manoeuvre.at_s, nullptr)) return;
      keep();
      if (manoeuvre.duration_s > 0) {
        restart(point);
        if (!to(point, std::min(manoeuvre.end_s(), flight_.to_s), &manoeuvre)) return;
        keep();
      } else {
        point.state.velocity_m_per_s += gcrs_from_rtn(point.state, manoeuvre.delta_v_m_per_s);
      }
      restart(point);
    }
    if (to(point, flight_.to_s, nullptr)) keep();
  }

  /// Flies on; without nodes up to the first time that is wanted. Whether it gets there.
  bool to(FlightPoint& point, double to_s, const Manoeuvre* burn) {
    Piece piece(forces_, settings_, burn);
    std::optional<FlightEnd> end;
    if (point.time_s < flight_.from_s) {
      end = piece.fly(point, std::min(to_s, flight_.from_s), nullptr);
      if (!end && point.time_s >= flight_.from_s) nodes_.push_back(point);
    }
    if (!end && point.time_s < to_s) end = piece.fly(point, to_s, &nodes_);
    if (!end) return true;
    path_.ends.push_back(*end);
    keep();
    return false;
  }

  void restart(const FlightPoint& point) {
    if (point.time_s >= flight_.from_s) nodes_.push_back(point);
  }

  /// Makes a segment of the nodes. One that is too short to divide by is left to the next.
  void keep() {
    constexpr double shortest_s = 1e-6;
    if (nodes_.empty()) return;
    const double first_s = nodes_.front().time_s, last_s = nodes_.back().time_s;
    if (last_s - first_s > shortest_s) {
      path_.segments.push_back(segment_of(nodes_));
      path_.segments.back().usable_start_s = left_over_s_.value_or(first_s);
      left_over_s_.reset();
    } else if (!left_over_s_) {
      left_over_s_ = first_s;
    }
    nodes_.clear();
  }

  const FlightForces& forces_;
  const NumericalFlight& flight_;
  const NumericalFlightSettings& settings_;
  NumericalPath path_;
  std::vector<FlightPoint> nodes_;
  std::optional<double> left_over_s_;  // where a segment that was too short begins
};

}  // namespace

NumericalPath integrate_flight(const FlightForces& forces, const NumericalFlight& flight,
                               const NumericalFlightSettings& settings) {
  return Way(forces, flight, settings).take();
}

}  // namespace dmise
