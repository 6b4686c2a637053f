#include "core/orbit/breakup/elements_at.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/orbit/sgp4/sgp4_batch.h"
#include "core/orbit/sgp4/sgp4_terms.h"

namespace dmise {
namespace {

using State = MotionState<Teme>;

constexpr int max_rounds = 60;
constexpr double gm_m3_per_s2 = sgp4::mu_km3_per_s2 * 1e9;
constexpr double close_m = 1e-3, close_m_per_s = 1e-6;  // at which a fit has converged
constexpr double far_m = 1.0, far_m_per_s = 1e-3;       // beyond which it has failed
constexpr double greatest_eccentricity = 0.999;
constexpr double min_inclination = 1e-12;

double positive_turn(double angle) { return angle - 2.0 * pi * std::floor(angle / (2.0 * pi)); }

/// Sets the orbit of `set` to the conic through `state`; false: it is not closed.
bool set_orbit(MeanElements& set, const State& state) {
  const Vec<Teme>&r = state.position_m, &v = state.velocity_m_per_s;
  const double distance = norm(r), inverse_a = 2.0 / distance - dot(v, v) / gm_m3_per_s2;
  const Vec<Teme> h = cross(r, v);
  if (!(inverse_a > 0.0) || !(norm(h) > 0.0)) return false;
  const double a = 1.0 / inverse_a;
  const double e_cos = 1.0 - distance / a, e_sin = dot(r, v) / std::sqrt(gm_m3_per_s2 * a);
  const double e = std::hypot(e_cos, e_sin), anomaly = std::atan2(e_sin, e_cos);
  if (!(e < greatest_eccentricity)) return false;
  const double across = std::hypot(h.x, h.y),
               node = across > min_inclination * norm(h) ? std::atan2(h.x, -h.y) : 0.0;
  const Vec<Teme> to_node{std::cos(node), std::sin(node), 0.0};
  const double latitude = std::atan2(dot(r, cross(unit(h), to_node)), dot(r, to_node));
  const double true_anomaly =
      std::atan2(std::sqrt(1.0 - e * e) * std::sin(anomaly), std::cos(anomaly) - e);
  set.mean_motion_rad_per_min = 60.0 * std::sqrt(gm_m3_per_s2 / (a * a * a));
  set.eccentricity = e;
  set.inclination_rad = std::atan2(across, h.z);
  set.raan_rad = positive_turn(node);
  set.argument_of_perigee_rad = positive_turn(latitude - true_anomaly);
  set.mean_anomaly_rad = positive_turn(anomaly - e_sin);
  return true;
}

/// One fit. SGP4's state differs from that of the conic with its elements by terms of J2, so that
/// the difference, subtracted from where the conic is to be, shrinks a thousandfold a round.
struct Fit {
  State aim;          // where the conic is to be
  MeanElements best;  // elements nearest so far
  double off = HUGE_VAL;
};

double off_of(const Vec<Teme>& dr, const Vec<Teme>& dv) {
  return std::max(norm(dr) / close_m, norm(dv) / close_m_per_s);
}

}  // namespace

std::vector<ElementsFault> fit_elements_at(const Utc& epoch, std::span<const State> states,
                                           std::span<MeanElements> sets) {
  const std::size_t count = states.size();
  std::vector<Fit> fits(count);
  std::vector<ElementsFault> faults(count, ElementsFault::none);
  std::vector<std::uint32_t> open;  // fits that go on
  for (std::size_t k = 0; k < count; ++k) {
    sets[k].epoch_jd1 = epoch.jd1, sets[k].epoch_jd2 = epoch.jd2;
    fits[k].aim = states[k];
    if (set_orbit(sets[k], states[k]))
      open.push_back(std::uint32_t(k));
    else
      faults[k] = ElementsFault::open;
  }
  for (int round = 0; round < max_rounds && !open.empty(); ++round) {
    std::vector<MeanElements> trial;
    for (const auto k : open) trial.push_back(sets[k]);
    const Sgp4Batch batch(trial, nullptr, SimdLevel::sse2);
    std::vector<std::uint32_t> next;
    for (std::size_t i = 0; i < open.size(); ++i) {
      const auto k = open[i];
      Fit& fit = fits[k];
      const Sgp4State there = batch.propagate_one(i, 0.0);
      if (there.code != Sgp4Code::ok) continue;
      const Vec<Teme> dr = states[k].position_m - there.position_m;
      const Vec<Teme> dv = states[k].velocity_m_per_s - there.velocity_m_per_s;
      const double off = off_of(dr, dv);
      if (!std::isfinite(off)) continue;
      if (off < fit.off) fit.off = off, fit.best = sets[k];
      if (off < 1.0) continue;
      fit.aim.position_m += dr, fit.aim.velocity_m_per_s += dv;
      if (set_orbit(sets[k], fit.aim)) next.push_back(k);
    }
    open = std::move(next);
  }
  const double enough = std::max(far_m / close_m, far_m_per_s / close_m_per_s);
  for (std::size_t k = 0; k < count; ++k) {
    if (faults[k] != ElementsFault::none) continue;
    if (fits[k].off <= enough)
      sets[k] = fits[k].best;
    else
      faults[k] = ElementsFault::no_path;
  }
  return faults;
}

}  // namespace dmise
