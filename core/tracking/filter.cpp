#include "core/tracking/filter.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>
#include <variant>

#include "core/base/error.h"
#include "core/tracking/sigma_points.h"

namespace dmise {

namespace {

/// An observation or a miss, and what is believed after it.
struct Event {
  SimTime time;
  bool seen = false;             // else a miss
  AngleObservation observation;  // if seen
  double detection_probability = 0.0;
  RootGaussian belief;
  double existence = 0.0;
  Innovation innovation;
};

/// Order in time; of one time by name, so that the order of arrival does not matter.
bool before(const Event& a, const Event& b) {
  return std::tie(a.time, a.seen, a.observation.sensor, a.observation.detection_id) <
         std::tie(b.time, b.seen, b.observation.sensor, b.observation.detection_id);
}

void check(bool good, const char* what) {
  if (!good) throw Error(std::string("filter: ") + what);
}

}  // namespace

struct OrbitFilter::Body {
  const ForceModel* forces;
  FilterSettings settings;
  EstimatedRows rows;
  std::vector<Event> events;  // a ring; the oldest is what all others follow from
  std::size_t oldest = 0, held = 1;
  int observations = 0;
  mutable std::vector<double> steps;

  Event& event(std::size_t i) { return events[(oldest + i) % events.size()]; }
  const Event& event(std::size_t i) const { return events[(oldest + i) % events.size()]; }
  const Event& last() const { return event(held - 1); }

  OrbitMatrix noise(double dt_s) const {
    return process_noise_root(settings.acceleration_noise_m2_per_s3, settings.drag_noise,
                              settings.srp_noise, dt_s);
  }

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
        belief = points.gaussian(noise(dt_s));
      }
      return {};
    });
  }

  /// Puts the belief after `previous` and this event's own evidence into the event.
  std::string_view follow(const Event& previous, Event& next) const {
    RootGaussian belief = previous.belief;
    if (!next.seen) {
      // The orbit stays: only a later observation moves it.
      next.belief = std::move(belief);
      const double p = next.detection_probability, e = previous.existence;
      next.existence = e * (1 - p) / (1 - e * p);
      return {};
    }
    if (const auto reason = move(belief, next.time); !reason.empty()) return reason;
    with_rows([&](auto n) {
      const SigmaPoints<n> points(rows, belief);
      const auto seen = points.see(next.observation.sensor_m);
      next.innovation = innovation_of(seen.direction, next.observation);
      next.belief = points.updated(seen, next.observation, next.innovation.residual_rad);
    });
    if (!is_sane(next.belief.mean) || !next.belief.root.allFinite())
      return "the observation leads to a state out of range";
    // Integrated probabilistic data association (Musicki, Evans & Stankovic 1994), one candidate.
    const double p = settings.detection_probability, e = previous.existence;
    const double ratio =
        1 - p + p * std::exp(next.innovation.log_likelihood) / settings.false_alarms_per_sr;
    next.existence = e > 0 ? e / (e + (1 - e) / ratio) : 0;
    return {};
  }

  /// Puts an event where it belongs and does those after it again.
  std::string_view insert(Event&& added, Innovation* found = nullptr) {
    std::size_t place = held;
    while (place > 0 && before(added, event(place - 1))) --place;
    if (place == 0) return "older than what is kept";
    // The kept ones are replaced only once all is well.
    std::string_view reason = follow(event(place - 1), added);
    if (!reason.empty()) return reason;
    if (added.seen && settings.gate_d2 > 0 && added.innovation.d2 > settings.gate_d2)
      return "the observation lies beyond the gate";
    if (found) *found = added.innovation;
    std::vector<Event> redone;
    for (std::size_t i = place; i < held; ++i) {
      redone.push_back(event(i));
      reason = follow(i == place ? added : redone[redone.size() - 2], redone.back());
      if (!reason.empty()) return reason;
    }
    if (held == events.size()) {
      oldest = (oldest + 1) % events.size();
      --held;
      --place;
    }
    ++held;
    event(place) = std::move(added);
    for (std::size_t i = 0; i < redone.size(); ++i) event(place + 1 + i) = std::move(redone[i]);
    return {};
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
    while (i > 0 && event(i - 1).time > time) --i;
    if (i == 0) return "older than what is kept";
    out = event(i - 1).belief;
    return move(out, time);
  }
};

OrbitFilter::OrbitFilter(const ForceModel& forces, const OrbitEstimate& start,
                         const FilterSettings& s)
    : body_(std::make_unique<Body>()) {
  const auto good = [](double x) { return std::isfinite(x) && x >= 0; };
  check(good(s.acceleration_noise_m2_per_s3) && good(s.drag_noise) && good(s.srp_noise),
        "noise must be >= 0");
  check(good(s.gate_d2), "gate_d2 must be >= 0");
  check(good(s.longest_s) && s.longest_s > 0, "longest_s must be > 0");
  check(s.kept >= 1, "kept must be >= 1");
  check(s.existence > 0 && s.existence < 1, "existence must be within 0 and 1");
  check(s.detection_probability > 0 && s.detection_probability < 1,
        "detection_probability must be within 0 and 1");
  check(good(s.false_alarms_per_sr) && s.false_alarms_per_sr > 0,
        "false_alarms_per_sr must be > 0");
  check(is_sane(start), "the estimate is not finite or out of range");
  body_->forces = &forces;
  body_->settings = s;
  EstimatedRows& rows = body_->rows;
  for (const int row : {drag_row, srp_row})
    if (start.covariance(row, row) > 0) rows.rows[std::size_t(rows.count++)] = row;

  // Root of the covariance with a unit diagonal: units differ by powers of ten.
  const int n = rows.count;
  OrbitMatrix scaled = OrbitMatrix::Identity();
  OrbitVector sigma = OrbitVector::Ones();
  const auto row = [&](int i) { return rows.rows[std::size_t(i)]; };
  for (int i = 0; i < n; ++i) {
    sigma[i] = std::sqrt(start.covariance(row(i), row(i)));
    check(sigma[i] > 0, "the covariance is not positive definite");
  }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      scaled(i, j) = start.covariance(row(i), row(j)) / (sigma[i] * sigma[j]);
  const Eigen::LLT<OrbitMatrix> root(scaled);
  check(root.info() == Eigen::Success, "the covariance is not positive definite");
  Event first;
  first.time = start.state.time;
  first.belief.mean = start.state;
  const OrbitMatrix lower = root.matrixL();
  for (int i = 0; i < n; ++i) first.belief.root.row(i).head(n) = sigma[i] * lower.row(i).head(n);
  first.existence = s.existence;
  body_->events.resize(std::size_t(s.kept) + 1);
  body_->events[0] = std::move(first);
}

OrbitFilter::~OrbitFilter() = default;
OrbitFilter::OrbitFilter(OrbitFilter&&) noexcept = default;
OrbitFilter& OrbitFilter::operator=(OrbitFilter&&) noexcept = default;
OrbitFilter::OrbitFilter(const OrbitFilter& other) : body_(std::make_unique<Body>(*other.body_)) {}
OrbitFilter& OrbitFilter::operator=(const OrbitFilter& other) {
  if (this != &other) body_ = std::make_unique<Body>(*other.body_);
  return *this;
}

SimTime OrbitFilter::time() const { return body_->last().belief.mean.time; }
OrbitEstimate OrbitFilter::estimate() const { return body_->estimate_of(body_->last().belief); }
double OrbitFilter::existence() const { return body_->last().existence; }
int OrbitFilter::observations() const { return body_->observations; }

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
  using Result = Outcome<Innovation>;
  if (const auto fault = fault_of(observation); !fault.empty()) return Result::refused(fault);
  Event event;
  event.time = observation.time;
  event.seen = true;
  event.observation = observation;
  Innovation found;
  const auto reason = body_->insert(std::move(event), &found);
  if (!reason.empty()) return Result::refused(reason);
  ++body_->observations;
  return found;
}

bool OrbitFilter::miss(const Miss& miss) {
  if (!(miss.detection_probability >= 0 && miss.detection_probability <= 1)) return false;
  Event event;
  event.time = miss.time;
  event.detection_probability = std::min(miss.detection_probability, 1 - 1e-9);
  return body_->insert(std::move(event)).empty();
}

}  // namespace dmise
