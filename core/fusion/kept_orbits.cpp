#include "core/fusion/kept_orbits.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace dmise {
namespace {

constexpr double ahead_s = 12 * 3600.0;  // first length of a path ahead; it doubles when asked for
constexpr double sigma_step_s = 1800.0;
constexpr std::size_t max_tried = 3;  // objects whose manoeuvre may explain an arc, nearest first
constexpr double reach_sigmas = 3.0;  // largest manoeuvre that is tried, in its expected sizes
// Along the motion a change of velocity moves an object three times as far as it goes in the time.
constexpr double drift_factor = 3.0;
constexpr double burn_m_per_s = 0.2;  // usual manoeuvres, one sigma along each axis

/// Whether an orbit explains an arc: without outliers, chi-square within five deviations of its
/// mean.
bool explains(const ArcNews& news) {
  return news.outliers == 0 && news.residual_d2 < news.degrees + 5 * std::sqrt(2.0 * news.degrees);
}

void sort_by_time(std::vector<AngleObservation>& arc) {
  std::ranges::sort(arc, [](const AngleObservation& a, const AngleObservation& b) {
    return std::tie(a.time, a.detection_id) < std::tie(b.time, b.detection_id);
  });
}

double sigma_of(const OrbitEstimate& estimate) {
  return std::sqrt(estimate.covariance.topLeftCorner<3, 3>().trace());
}

std::array<double, 3> numbers_of(const Vec<Rtn>& v) { return {v.x, v.y, v.z}; }

KeptManoeuvre described(const FoundManoeuvre& found) {
  KeptManoeuvre out{.time = found.change.time,
                    .time_sigma_s = found.time_sigma_s,
                    .delta_v_m_per_s = numbers_of(found.change.delta_v_m_per_s),
                    .covariance = lower_triangle<3>(found.covariance),
                    .modes = {},
                    .found = found.found,
                    .confidence = found.confidence};
  if (found.modes.size() < 2) return out;
  for (const ManoeuvreMode& m : found.modes)
    out.modes.push_back({.time = m.change.time,
                         .time_sigma_s = m.time_sigma_s,
                         .delta_v_m_per_s = numbers_of(m.change.delta_v_m_per_s),
                         .covariance = lower_triangle<3>(m.covariance),
                         .chance = m.chance});
  return out;
}

}  // namespace

OrbitEstimate with_usual_scales(OrbitEstimate estimate) {
  constexpr double scale_m2_per_kg = 0.02, sigma_m2_per_kg = 0.02;
  estimate.state.drag_m2_per_kg = estimate.state.srp_m2_per_kg = scale_m2_per_kg;
  for (const int row : {drag_row, srp_row}) {
    estimate.covariance.row(row).setZero();
    estimate.covariance.col(row).setZero();
    estimate.covariance(row, row) = sigma_m2_per_kg * sigma_m2_per_kg;
  }
  return estimate;
}

KeptOrbits::KeptOrbits(const Clock& clock, SimTime first, SimTime last)
    : last_(last), forces_(clock, first, last) {}

std::vector<std::pair<std::size_t, KeptOrbits::Place>> KeptOrbits::places(SimTime time) {
  std::vector<std::pair<std::size_t, Place>> out;
  for (const auto& [object, kept] : objects_)
    if (const auto there = place(object, time)) out.emplace_back(object, *there);
  return out;
}

bool KeptOrbits::look_ahead(Kept& kept, SimTime to) {
  if (!kept.last) return false;
  const SimTime from = kept.last->state.time;
  if (kept.ahead && to <= kept.ahead->end()) return true;
  double length_s = ahead_s;
  while (from + sim_seconds(length_s) < to) length_s *= 2;
  const SimTime end = std::min(last_, from + sim_seconds(length_s));
  if (end < to || !(from < end)) return false;
  auto path = ArcPath::fly(forces_, kept.last->state, {}, end);
  if (!path) return false;
  kept.ahead = std::move(*path);
  const OrbitEstimate burnt = perhaps_manoeuvred(*kept.last, burn_m_per_s);
  kept.sigmas.clear();
  const auto add = [&](SimTime t) {
    kept.sigmas.push_back({sigma_of(moved_along(forces_, *kept.ahead, kept.last->covariance, t)),
                           sigma_of(moved_along(forces_, *kept.ahead, burnt.covariance, t))});
  };
  for (SimTime t = from; t < end; t = t + sim_seconds(sigma_step_s)) add(t);
  add(end);
  return true;
}

std::optional<KeptOrbits::Place> KeptOrbits::place(std::size_t object, SimTime time) {
  Kept& kept = objects_.at(object);
  if (!kept.last) return std::nullopt;
  if (time <= kept.last->state.time) {
    const auto then = kept.object.estimate_at(time);
    if (!then) return std::nullopt;
    return Place{then->state, sigma_of(*then), sigma_of(*then)};
  }
  if (!look_ahead(kept, time)) return std::nullopt;
  const double steps = (time - kept.last->state.time).seconds() / sigma_step_s;
  const auto k = std::min(std::size_t(steps), kept.sigmas.size() - 1);
  const Sigmas& now = kept.sigmas[k];
  const Sigmas& next = kept.sigmas[std::min(k + 1, kept.sigmas.size() - 1)];
  return Place{kept.ahead->at(time), std::max(now.sigma_m, next.sigma_m),
               std::max(now.burnt_sigma_m, next.burnt_sigma_m)};
}

Outcome<OrbitEstimate> KeptOrbits::estimate(std::size_t object, SimTime time) {
  Kept& kept = objects_.at(object);
  if (!kept.last || time <= kept.last->state.time || !look_ahead(kept, time))
    return kept.object.estimate_at(time);
  return moved_along(forces_, *kept.ahead, kept.last->covariance, time);
}

Outcome<OrbitEstimate> KeptOrbits::burnt(std::size_t object, SimTime time) {
  Kept& kept = objects_.at(object);
  if (!kept.last || time <= kept.last->state.time || !look_ahead(kept, time))
    return kept.object.estimate_at(time);
  const OrbitEstimate last = perhaps_manoeuvred(*kept.last, burn_m_per_s);
  return moved_along(forces_, *kept.ahead, last.covariance, time);
}

Outcome<KeptOrbit> KeptOrbits::take(std::size_t object, const OrbitEstimate& prior,
                                    std::vector<AngleObservation> arc) {
  using Result = Outcome<KeptOrbit>;
  const auto [at, is_new] =
      objects_.try_emplace(object, Kept{CatalogueObject(forces_, with_usual_scales(prior))});
  Kept& kept = at->second;
  std::erase_if(arc, [&](const AngleObservation& o) { return o.time < kept.object.time(); });
  sort_by_time(arc);
  const auto news = kept.object.take(arc);
  const auto now = news ? kept.object.estimate_at(arc.back().time)
                        : Outcome<OrbitEstimate>::refused(news.reason);
  if (!now) {
    if (is_new) objects_.erase(at);
    return Result::refused(now.reason);
  }
  ++kept.arcs;
  kept.last = *now;
  kept.ahead.reset();
  KeptOrbit out{.time = now->state.time,
                .position_m = now->state.position_m,
                .velocity_m_per_s = now->state.velocity_m_per_s,
                .covariance = lower_triangle<6>(now->covariance),
                .drag_m2_per_kg = now->state.drag_m2_per_kg,
                .drag_sigma_m2_per_kg = std::sqrt(now->covariance(drag_row, drag_row)),
                .srp_m2_per_kg = now->state.srp_m2_per_kg,
                .srp_sigma_m2_per_kg = std::sqrt(now->covariance(srp_row, srp_row)),
                .arcs = kept.arcs,
                .detections = std::uint32_t(arc.size()),
                .outliers = std::uint32_t(news->outliers),
                .innovation_d2 = std::max(0.0, news->innovation_d2),
                .degrees = std::uint32_t(news->degrees),
                .manoeuvre = {},
                .revised = {}};
  if (news->manoeuvre) out.manoeuvre = described(*news->manoeuvre);
  for (const FoundManoeuvre& m : kept.object.open_manoeuvres())
    if (!news->manoeuvre || m.found != news->manoeuvre->found) out.revised.push_back(described(m));
  return out;
}

std::optional<std::size_t> KeptOrbits::owner_of(const OrbitState& seen,
                                                std::vector<AngleObservation> arc,
                                                const std::function<bool(std::size_t)>& may_be) {
  sort_by_time(arc);
  const double reach_m_per_s =
      reach_sigmas * drift_factor * forces_.settings().manoeuvre_sigma_m_per_s;
  std::vector<std::pair<double, std::size_t>> near;
  for (auto& [object, kept] : objects_) {
    if (!may_be(object) || !kept.last || arc.front().time < kept.object.time()) continue;
    const auto expected = place(object, seen.time);
    if (!expected) continue;
    const double apart_m = norm(expected->state.position_m - seen.position_m);
    const double since_s = (seen.time - kept.last->state.time).seconds();
    if (apart_m < reach_m_per_s * since_s + reach_sigmas * expected->sigma_m)
      near.emplace_back(apart_m, object);
  }
  std::ranges::sort(near);
  near.resize(std::min(near.size(), max_tried));
  for (const auto& [apart_m, object] : near) {
    CatalogueObject trial = objects_.at(object).object;
    const auto news = trial.take(arc);
    if (news && explains(*news)) return object;
  }
  return std::nullopt;
}

}  // namespace dmise
