#include <algorithm>
#include <cmath>

#include "core/tracking/initial/initial_orbit.h"
#include "core/tracking/initial/three_lines.h"
#include "core/tracking/predict.h"

namespace dmise {

namespace {

/// Candidates that are fitted, out of all that were found.
constexpr std::size_t max_fits = 8;

struct Candidate {
  OrbitState state;
  double cost = 0.0;
};

/// Sum over observations of log(1 + d^2) on the two-body path: far misses do not hide near ones.
double cost_of(const OrbitState& state, std::span<const AngleObservation> observations) {
  double cost = 0;
  for (const AngleObservation& o : observations) {
    OrbitState moved = state;
    if (!move_two_body(moved, (o.time - state.time).seconds())) return INFINITY;
    moved.time = o.time;
    if (!(norm(moved.position_m - o.sensor_m) > 1.0)) return INFINITY;
    const OrbitEstimate exact{moved};
    cost += std::log1p(innovation_of(predict_direction(exact, o.sensor_m, o.time), o).d2);
  }
  return cost;
}

/// Three lines over the arc, and then over its inner part.
std::vector<std::array<AngleObservation, 3>> triples(const std::vector<AngleObservation>& sorted) {
  std::vector<std::array<AngleObservation, 3>> out;
  const std::size_t n = sorted.size();
  const SimTime first = sorted.front().time, last = sorted.back().time;
  for (const double margin : {0.0, 0.15}) {
    const auto nearest = [&](double share) {
      const double at_s = share * (last - first).seconds();
      std::size_t best = 0;
      for (std::size_t i = 1; i < n; ++i)
        if (std::fabs((sorted[i].time - first).seconds() - at_s) <
            std::fabs((sorted[best].time - first).seconds() - at_s))
          best = i;
      return best;
    };
    const std::size_t a = nearest(margin), b = nearest(0.5), c = nearest(1 - margin);
    if (sorted[a].time < sorted[b].time && sorted[b].time < sorted[c].time)
      out.push_back({sorted[a], sorted[b], sorted[c]});
  }
  return out;
}

void add_region(const std::vector<AngleObservation>& sorted, const OrbitLimits& limits,
                std::vector<OrbitState>& out) {
  std::vector<AngleObservation> one;
  for (const AngleObservation& o : sorted)
    if (o.sensor == sorted.front().sensor && (o.time - sorted.front().time).seconds() < 60)
      one.push_back(o);
  const auto tracklet = tracklet_of(one);
  if (!tracklet) return;
  if (const auto region =
          admissible_region(*tracklet, {.limits = limits, .ranges = 25, .range_rates = 11}))
    out.insert(out.end(), region->begin(), region->end());
}

/// Fits of the candidates, within the limits; none: the reason. Residuals are in order of time.
Outcome<std::vector<BatchFit>> fits_of(const ForceModel& forces,
                                       std::span<const AngleObservation> observations,
                                       const BatchSettings& settings, const OrbitLimits& limits) {
  using Result = Outcome<std::vector<BatchFit>>;
  if (observations.size() < 3) return Result::refused("fewer than three observations");
  std::vector<AngleObservation> sorted(observations.begin(), observations.end());
  for (const AngleObservation& o : sorted)
    if (const auto fault = fault_of(o); !fault.empty()) return Result::refused(fault);
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.time < b.time; });
  std::vector<OrbitState> found;
  std::string_view reason = "the three times do not increase";
  for (const auto& three : triples(sorted)) {
    GoodingSettings gooding;
    gooding.limits = limits;
    if (const auto orbits = gooding_orbit(three, gooding))
      found.insert(found.end(), orbits->begin(), orbits->end());
    else
      reason = orbits.reason;
    if (const auto orbits = gauss_orbit(three, limits))
      found.insert(found.end(), orbits->begin(), orbits->end());
  }
  add_region(sorted, limits, found);
  if (found.empty()) return Result::refused(reason);
  std::vector<Candidate> candidates;
  for (const OrbitState& state : found) {
    const double cost = cost_of(state, sorted);
    if (std::isfinite(cost)) candidates.push_back({state, cost});
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const auto& a, const auto& b) { return a.cost < b.cost; });
  if (candidates.size() > max_fits) candidates.resize(max_fits);
  std::vector<BatchFit> fits;
  for (const Candidate& candidate : candidates) {
    auto fit = fit_orbit(forces, sorted, candidate.state, settings);
    if (!fit)
      reason = fit.reason;
    else if (within(limits, fit->estimate.state))
      fits.push_back(std::move(*fit));
  }
  if (fits.empty())
    return Result::refused(reason.empty() ? "no candidate fits the observations" : reason);
  return fits;
}

}  // namespace

Outcome<std::vector<BatchFit>> one_arc_orbits(const ForceModel& forces,
                                              std::span<const AngleObservation> observations,
                                              const BatchSettings& batch,
                                              const OrbitLimits& limits) {
  auto fits = fits_of(forces, observations, batch, limits);
  if (fits) std::ranges::stable_sort(*fits, {}, &BatchFit::chi2);
  return fits;
}

Outcome<BatchFit> one_arc_orbit(const ForceModel& forces,
                                std::span<const AngleObservation> observations,
                                const BatchSettings& batch, const OrbitLimits& limits) {
  using Result = Outcome<BatchFit>;
  const auto fits = fits_of(forces, observations, batch, limits);
  if (!fits) return Result::refused(fits.reason);
  const BatchFit* best = nullptr;
  for (const BatchFit& fit : *fits) {
    const auto taken = std::count(fit.taken.begin(), fit.taken.end(), true);
    if (!best || taken > std::count(best->taken.begin(), best->taken.end(), true) ||
        fit.chi2 < best->chi2)
      best = &fit;
  }
  // Six sigma of the chi-square: what no orbit explains is refused.
  const double degrees = std::max(best->degrees_of_freedom, 1);
  if (!(batch.huber_sigma > 0) && best->chi2 > degrees + 6 * std::sqrt(2 * degrees) + 12)
    return Result::refused("no orbit fits the observations: they are of several objects");
  // Residuals in the order of the input.
  return fit_orbit(forces, observations, best->estimate.state, batch);
}

}  // namespace dmise
