#include "core/fusion/track_start.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "core/orbit/two_body.h"
#include "core/tracking/initial/initial_orbit.h"

namespace dmise {
namespace {

constexpr double min_baseline_m = 10e3;
constexpr double shortest_gap_s = 1.0;    // between two places of one orbit
constexpr double min_perigee_m = 6.45e6;  // 70 km above the ground
constexpr double largest_apogee_m = 1e8;
constexpr double start_sigmas = 4.0;     // reach of coarse tests
constexpr double longest_miss_m = 50e3;  // between two lines
constexpr double largest_chi2 = 13.8;    // for an orbit of 2 degrees of freedom: 1e-3

auto order(const LooseSource& s) {
  return std::tie(seen(s).time, seen(s).sensor, seen(s).detection_id);
}

/// Whether two lines pass each other closely, at a height of an orbit: cheap, for most do not.
bool may_meet(const AngleObservation& a, const AngleObservation& b) {
  const Vec<Gcrs> base = b.sensor_m - a.sensor_m;
  if (norm(base) < min_baseline_m) return false;
  const double c = dot(a.direction, b.direction), s2 = 1 - c * c;
  if (s2 < 1e-8) return false;
  const double ab = dot(base, a.direction), bb = dot(base, b.direction);
  const double range_a = (ab - c * bb) / s2, range_b = (c * ab - bb) / s2;
  if (!(range_a > 0) || !(range_b > 0)) return false;
  const Vec<Gcrs> at_a = a.sensor_m + a.direction * range_a;
  const Vec<Gcrs> at_b = b.sensor_m + b.direction * range_b;
  if (norm(at_a) < min_perigee_m || norm(at_a) > largest_apogee_m) return false;
  const double moved_m = 8e3 * std::fabs((a.time - b.time).seconds());
  const double sigma_m = std::hypot(range_a * sigma_rad(a), range_b * sigma_rad(b));
  return norm(at_a - at_b) < std::min(longest_miss_m, start_sigmas * sigma_m + moved_m);
}

}  // namespace

TrackStart::TrackStart(const ForceModel& forces, const FusionSettings& settings)
    : forces_(forces), settings_(settings) {}

std::optional<TrackStart::Place> TrackStart::meet(const LooseSource& a,
                                                  const LooseSource& b) const {
  if (seen(a).sensor == seen(b).sensor || !may_meet(seen(a), seen(b))) return std::nullopt;
  const AngleObservation lines[] = {seen(a), seen(b)};
  TriangulationSettings triangulation;
  triangulation.longest_s = settings_.simultaneous_s;
  const auto where = triangulate(lines, {}, triangulation);
  if (!where) return std::nullopt;
  return Place{*where, std::sqrt(where->covariance_m2.trace()), a, b};
}

bool TrackStart::may_be_one(const Place& from, const Place& to) const {
  const double dt_s = (to.where.time - from.where.time).seconds();
  if (dt_s < shortest_gap_s || dt_s > settings_.start_window_s) return false;
  // Places of the same two sites are wrong in nearly the same direction.
  const Vec<Gcrs> r = to.where.position_m;
  const double sigma = start_sigmas * std::hypot(from.sigma_m, to.sigma_m) / dt_s;
  const double distance = norm(r), escape = std::sqrt(2 * earth_gm_m3_per_s2 / distance);
  const Vec<Gcrs> mean = (r - from.where.position_m) / dt_s;
  const double speed = norm(mean);
  if (speed - sigma > escape) return false;
  if (sigma > 0.2 * escape) return false;  // not to be told from chance
  const Vec<Gcrs> v = mean - r * (earth_gm_m3_per_s2 / (distance * distance * distance) * dt_s / 2);
  // The most circular velocity within the errors.
  const Vec<Gcrs> up = r / distance;
  const double radial = dot(v, up);
  const double min_radial = std::max(0.0, std::fabs(radial) - sigma);
  const Vec<Gcrs> level = v - up * radial;
  const double circular = escape / std::sqrt(2.0), across = norm(level);
  const double best = across + std::clamp(circular - across, -sigma, sigma);
  OrbitState state{to.where.time, r, level * (best / std::max(across, 1e-9)) + up * min_radial};
  return perigee_m(state) > min_perigee_m && apogee_m(state) < largest_apogee_m;
}

std::vector<StartedOrbit> TrackStart::add(const std::vector<LooseSource>& sources) {
  std::vector<LooseSource> fresh;
  for (const LooseSource& s : sources)
    if (!s.source.star_like) fresh.push_back(s);
  std::ranges::sort(fresh, [](const auto& a, const auto& b) { return order(a) < order(b); });

  // Places of the new sources among each other and with what came before.
  std::vector<Place> found;
  const auto pair_up = [&](const LooseSource& a, const LooseSource& b) {
    if (std::fabs((seen(a).time - seen(b).time).seconds()) > settings_.simultaneous_s) return;
    if (auto place = order(a) < order(b) ? meet(a, b) : meet(b, a))
      found.push_back(std::move(*place));
  };
  for (std::size_t i = 0; i < fresh.size(); ++i) {
    for (const LooseSource& old : loose_) pair_up(old, fresh[i]);
    for (std::size_t j = i + 1; j < fresh.size(); ++j) pair_up(fresh[i], fresh[j]);
  }
  const std::size_t before = places_.size();
  places_.insert(places_.end(), found.begin(), found.end());
  loose_.insert(loose_.end(), fresh.begin(), fresh.end());
  std::ranges::sort(loose_, [](const auto& a, const auto& b) { return order(a) < order(b); });

  std::vector<StartedOrbit> orbits;
  TriangulationSettings triangulation;
  triangulation.longest_s = settings_.simultaneous_s;
  for (std::size_t i = before; i < places_.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const bool later = places_[i].where.time > places_[j].where.time;
      const Place &from = later ? places_[j] : places_[i], &to = later ? places_[i] : places_[j];
      if (!may_be_one(from, to)) continue;
      const AngleObservation lines[] = {seen(from.a), seen(from.b), seen(to.a), seen(to.b)};
      auto fit = two_site_orbit(forces_, lines, triangulation);
      if (!fit || fit->chi2 > largest_chi2 || !is_sane(fit->estimate) ||
          perigee_m(fit->estimate.state) < min_perigee_m ||
          apogee_m(fit->estimate.state) > largest_apogee_m)
        continue;
      orbits.push_back({std::move(*fit), {from.a, from.b, to.a, to.b}});
    }
  std::ranges::stable_sort(orbits, {}, [](const StartedOrbit& o) { return o.fit.chi2; });
  std::vector<StartedOrbit> taken;
  std::set<std::string> used;
  for (StartedOrbit& orbit : orbits) {
    if (std::ranges::any_of(orbit.sources,
                            [&](const auto& s) { return used.contains(seen(s).detection_id); }))
      continue;
    for (const LooseSource& s : orbit.sources) used.insert(seen(s).detection_id);
    taken.push_back(std::move(orbit));
  }

  if (!loose_.empty()) {
    const SimTime oldest = seen(loose_.back()).time - sim_seconds(settings_.start_window_s);
    std::erase_if(loose_, [&](const LooseSource& s) { return seen(s).time < oldest; });
    std::erase_if(places_, [&](const Place& p) { return p.where.time < oldest; });
  }
  return taken;
}

void TrackStart::forget(const std::vector<std::string>& ids) {
  const std::set<std::string> gone(ids.begin(), ids.end());
  const auto is_gone = [&](const LooseSource& s) { return gone.contains(seen(s).detection_id); };
  std::erase_if(loose_, is_gone);
  std::erase_if(places_, [&](const Place& p) { return is_gone(p.a) || is_gone(p.b); });
}

}  // namespace dmise
