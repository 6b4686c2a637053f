#include "core/tracking/filter.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <tuple>
#include <type_traits>
#include <utility>

#include "core/base/error.h"
#include "core/tracking/sigma_points.h"

namespace dmise {

namespace {

/// An observation, and what is believed after it. The first has only the time of the start.
struct Event {
  AngleObservation observation;
  RootGaussian belief;
};

/// Order in time; of one time by name, so that the order of arrival does not matter.
bool before(const AngleObservation& a, const AngleObservation& b) {
  return std::tie(a.time, a.sensor, a.detection_id) < std::tie(b.time, b.sensor, b.detection_id);
}

/// Longest time over which noise is added as if the object moved without forces [s]: in a low
/// orbit it turns by 7 deg.
constexpr double noise_span_s = 120.0;

constexpr double range_gate_sigmas = 6.0;

/// The end of the next part of the way from `from` to `to`.
SimTime next_noise_time(SimTime from, SimTime to, bool noise) {
  const SimTime span = sim_seconds(noise_span_s);
  if (!noise || (to - from <= span && from - to <= span)) return to;
  return to > from ? from + span : from - span;
}

/// Root L of the covariance L L' that white noise of the acceleration, of this spectral density
/// along each axis, adds in `dt_s` >= 0.
OrbitMatrix process_noise_root(double density_m2_per_s3, double dt_s) {
  OrbitMatrix root = OrbitMatrix::Zero();
  const double t = std::sqrt(density_m2_per_s3 * dt_s);
  for (int axis = 0; axis < 3; ++axis) {
    root(axis, axis) = t * dt_s / std::sqrt(3.0);
    root(axis + 3, axis) = t * std::sqrt(3.0) / 2;
    root(axis + 3, axis + 3) = t / 2;
  }
  return root;
}

void check(bool good, const char* what) {
  if (!good) throw Error(std::string("filter: ") + what);
}

/// Returns what is estimated, and the belief of a start with its root; none where the covariance is
/// not positive definite.
std::optional<std::pair<EstimatedRows, RootGaussian>> belief_of(const OrbitEstimate& start) {
  EstimatedRows rows;
  for (const int row : {drag_row, srp_row})
    if (start.covariance(row, row) > 0) rows.rows[std::size_t(rows.count++)] = row;
  const int n = rows.count;
  const auto [scaled, sigma] =
      unit_variances(start.covariance, std::span(rows.rows).first(std::size_t(n)));
  if (!(sigma.array() > 0).all()) return std::nullopt;
  const Eigen::LLT<OrbitMatrix> root(scaled);
  if (root.info() != Eigen::Success) return std::nullopt;
  RootGaussian belief;
  belief.mean = start.state;
  const OrbitMatrix lower = root.matrixL();
  for (int i = 0; i < n; ++i) belief.root.row(i).head(n) = sigma[i] * lower.row(i).head(n);
  return std::pair(rows, belief);
}

}  // namespace

struct OrbitFilter::Body {
  const ForceModel* forces;
  FilterSettings settings;
  EstimatedRows rows;
  std::vector<Event> events;  // ring buffer; the others follow from the oldest
  std::size_t oldest = 0, held = 1;
  mutable std::vector<double> steps;

  Event& event(std::size_t i) { return events[(oldest + i) % events.size()]; }
  const Event& event(std::size_t i) const { return events[(oldest + i) % events.size()]; }
  const Event& last() const { return event(held - 1); }

  template <class Work>
  auto with_rows(Work&& work) const {
    switch (rows.count) {
      case 6:
        return work(std::integral_constant<int, 6>());
      case 7:
        return work(std::integral_constant<int, 7>());
      default:
        return work(std::integral_constant<int, 8>());
    }
  }

  std::string_view move(RootGaussian& belief, SimTime to) const {
    const double apart_s = 1e-9 * std::fabs(double(to.ns) - double(belief.mean.time.ns));
    if (apart_s > settings.longest_s) return "too long after what is known";
    return with_rows([&](auto n) -> std::string_view {
      PropagationSettings propagation;
      propagation.position_tolerance_m = 1e-3;
      while (belief.mean.time != to) {
        const SimTime next =
            next_noise_time(belief.mean.time, to, settings.acceleration_noise_m2_per_s3 > 0);
        const double dt_s = std::fabs((next - belief.mean.time).seconds());
        SigmaPoints<n> points(rows, belief);
        const auto reason = points.move(*forces, next, propagation, steps);
        if (!reason.empty()) return reason;
        belief = points.gaussian(process_noise_root(settings.acceleration_noise_m2_per_s3, dt_s));
      }
      return {};
    });
  }

  /// Puts the belief after `previous` and this event's own observation into the event. Returns the
  /// innovation of the observation.
  Outcome<Innovation> follow(const Event& previous, Event& next) const {
    using Result = Outcome<Innovation>;
    RootGaussian belief = previous.belief;
    if (const auto reason = move(belief, next.observation.time); !reason.empty())
      return Result::refused(reason);
    Innovation found;
    with_rows([&](auto n) {
      const SigmaPoints<n> points(rows, belief);
      const auto seen = points.see(next.observation.sensor_m);
      found = innovation_of(seen.direction, next.observation);
      next.belief = points.updated(seen, next.observation, found.residual_rad);
    });
    if (!take_range(next)) return Result::refused("the range is not that of the object");
    if (!is_sane(next.belief.mean) || !next.belief.root.allFinite())
      return Result::refused("the observation leads to a state out of range");
    return found;
  }

  /// Takes range and range rate of an event into what is believed after its direction. False if
  /// one is not within the gate.
  bool take_range(Event& event) const {
    const AngleObservation& seen = event.observation;
    const Eigen::Vector3d sensor_m = eigen_of(seen.sensor_m);
    const auto take = [&](const std::optional<MeasuredNumber>& measured, const auto& number_of) {
      return !measured || with_rows([&](auto n) {
        const auto after = SigmaPoints<n>(rows, event.belief)
                               .updated(
                                   [&](const Eigen::Vector3d& r, const Eigen::Vector3d& v) {
                                     return number_of(line_of_light(r, v, sensor_m));
                                   },
                                   *measured, range_gate_sigmas);
        if (after) event.belief = *after;
        return after.has_value();
      });
    };
    return take(seen.range_m, [](const LineOfLight& line) { return line.range_m; }) &&
           take(seen.range_rate_m_per_s, [&](const LineOfLight& line) {
             return range_rate_m_per_s(line, eigen_of(seen.sensor_m_per_s));
           });
  }

  /// Inserts an observation at its place in time and processes those after it again.
  Outcome<Innovation> insert(const AngleObservation& observation) {
    std::size_t place = held;
    while (place > 0 && before(observation, event(place - 1).observation)) --place;
    if (place == 0) return Outcome<Innovation>::refused("older than what is kept");
    // The kept ones are replaced only once all is well.
    Event added{observation, {}};
    const auto found = follow(event(place - 1), added);
    if (!found) return found;
    std::vector<Event> redone;
    for (std::size_t i = place; i < held; ++i) {
      redone.push_back(event(i));
      const auto again = follow(i == place ? added : redone[redone.size() - 2], redone.back());
      if (!again) return again;
    }
    if (held == events.size()) {
      oldest = (oldest + 1) % events.size();
      --held;
      --place;
    }
    ++held;
    event(place) = std::move(added);
    for (std::size_t i = 0; i < redone.size(); ++i) event(place + 1 + i) = std::move(redone[i]);
    return found;
  }

  OrbitEstimate estimate_of(const RootGaussian& belief) const {
    OrbitEstimate out{belief.mean};
    const OrbitMatrix product = belief.root * belief.root.transpose();
    for (int i = 0; i < rows.count; ++i)
      for (int j = 0; j < rows.count; ++j)
        out.covariance(rows.rows[std::size_t(i)], rows.rows[std::size_t(j)]) = product(i, j);
    return out;
  }

  /// The belief of the last event that is not after `time`, moved there.
  std::string_view belief_at(SimTime time, RootGaussian& out) const {
    std::size_t i = held;
    while (i > 0 && event(i - 1).observation.time > time) --i;
    if (i == 0) return "older than what is kept";
    out = event(i - 1).belief;
    return move(out, time);
  }
};

bool OrbitFilter::can_start(const OrbitEstimate& estimate) {
  return is_sane(estimate) && belief_of(estimate).has_value();
}

OrbitFilter::OrbitFilter(const ForceModel& forces, const OrbitEstimate& start,
                         const FilterSettings& s)
    : body_(std::make_unique<Body>()) {
  const auto good = [](double x) { return std::isfinite(x) && x >= 0; };
  check(good(s.acceleration_noise_m2_per_s3), "noise must be >= 0");
  check(good(s.longest_s) && s.longest_s > 0, "longest_s must be > 0");
  check(s.kept >= 1, "kept must be >= 1");
  check(is_sane(start), "the estimate is not finite or out of range");
  body_->forces = &forces;
  body_->settings = s;
  const auto belief = belief_of(start);
  check(belief.has_value(), "the covariance is not positive definite");
  Event first;
  first.observation.time = start.state.time;
  std::tie(body_->rows, first.belief) = *belief;
  body_->events.resize(std::size_t(s.kept) + 1);
  body_->events[0] = std::move(first);
}

OrbitFilter::~OrbitFilter() = default;
OrbitFilter::OrbitFilter(OrbitFilter&&) noexcept = default;

SimTime OrbitFilter::time() const { return body_->last().belief.mean.time; }
OrbitEstimate OrbitFilter::estimate() const { return body_->estimate_of(body_->last().belief); }

Outcome<OrbitEstimate> OrbitFilter::estimate_at(SimTime time) const {
  RootGaussian belief;
  if (const auto reason = body_->belief_at(time, belief); !reason.empty())
    return Outcome<OrbitEstimate>::refused(reason);
  return body_->estimate_of(belief);
}

Outcome<PredictedDirection> OrbitFilter::predict(SimTime time, const Vec<Gcrs>& sensor_m) const {
  RootGaussian belief;
  if (const auto reason = body_->belief_at(time, belief); !reason.empty())
    return Outcome<PredictedDirection>::refused(reason);
  return body_->with_rows([&](auto n) -> Outcome<PredictedDirection> {
    return SigmaPoints<n>(body_->rows, belief).see(sensor_m).direction;
  });
}

Outcome<Innovation> OrbitFilter::innovation(const AngleObservation& observation) const {
  using Result = Outcome<Innovation>;
  if (const auto fault = fault_of(observation); !fault.empty()) return Result::refused(fault);
  const auto predicted = predict(observation.time, observation.sensor_m);
  if (!predicted) return Result::refused(predicted.reason);
  return innovation_of(*predicted, observation);
}

Outcome<Innovation> OrbitFilter::update(const AngleObservation& observation) {
  if (const auto fault = fault_of(observation); !fault.empty())
    return Outcome<Innovation>::refused(fault);
  return body_->insert(observation);
}

}  // namespace dmise
