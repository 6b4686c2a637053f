#include "core/fusion/arc_start.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <span>
#include <tuple>

#include "core/base/numeric/chi_square.h"
#include "core/base/units.h"
#include "core/tracking/initial/initial_orbit.h"
#include "core/tracking/initial/three_lines.h"

namespace dmise {
namespace {

constexpr std::size_t max_per_exposure = 16;  // the brightest
constexpr std::size_t max_fits = 2;           // in one tick, each some 30 ms
constexpr int max_skipped = 3;                // exposures in a row in which it was not found
constexpr double shortest_arc_gap_s = 1.0;
constexpr double fastest_rad_per_s = 0.035;  // 2 deg/s: 8 km/s at 230 km
constexpr double arc_sigmas = 5.0;
/// Largest attraction over the speed across the line of sight, and range rate over range [1/s].
constexpr double gravity_over_speed = 9.8 / 3000.0, range_rate_over_range = 0.005;
/// No orbit is tried if more chance arcs as long and as smooth are expected to end in a source.
constexpr double most_by_chance = 1e-3;
constexpr double largest_range_sigma = 0.1;  // relative: a filter takes no wider ellipse
constexpr double as_likely = 9.2;            // chi-square by which another orbit must be worse
constexpr OrbitLimits limits{.min_perigee_m = 6.45e6, .largest_apogee_m = 1e8};

/// Orders one sensor's sources. Those of an exposure have each its own time where rows are exposed
/// one after the other.
auto order(const LooseSource& s) { return std::tie(s.frame, seen(s).time, seen(s).detection_id); }

/// Where a path continues at an earlier time, and how far off it may be.
struct Continued {
  Vec<Gcrs> direction, along;
  double along_rad = 0.0, across_rad = 0.0;
};

/// Two or three points of a path by falling time: a great circle at constant rate, or a parabola.
/// The bounds are of what gravity, range rate and the turn of the line of sight may add.
Continued continued(const std::vector<const LooseSource*>& arc, SimTime time) {
  const std::size_t n = arc.size();
  const LooseSource &a = *arc[n - 1], &b = *arc[n - 2];
  const Vec<Gcrs>&ua = seen(a).direction, &ub = seen(b).direction;
  const double dt = (seen(a).time - time).seconds();  // > 0, beyond a
  const double ab = (seen(b).time - seen(a).time).seconds();
  const double rate = angle_rad(ua, ub) / ab;
  const double noise = arc_sigmas * std::max(sigma_rad(seen(a)), sigma_rad(seen(b)));
  Continued out;
  if (n == 2) {
    const Vec<Gcrs> tangent = unit(ua - ub * dot(ua, ub));  // at b, towards a
    const double angle = rate * (ab + dt);
    out.direction = ub * std::cos(angle) + tangent * std::sin(angle);
    const double spread = rate * dt * (dt + ab) / 2;
    const double amplified = noise * (1 + 2 * dt / ab);
    out.along_rad = (3 * rate + 2 * range_rate_over_range) * spread + amplified;
    out.across_rad = gravity_over_speed * spread + amplified;
  } else {
    const LooseSource& c = *arc[n - 3];
    const double bc = (seen(c).time - seen(b).time).seconds();
    // Newton's divided differences about a.
    const Vec<Gcrs> first = (ub - ua) / ab;
    const Vec<Gcrs> second = ((seen(c).direction - ub) / bc - first) / (ab + bc);
    out.direction = unit(ua - first * dt + second * (dt * (dt + ab)));
    const double w = rate + range_rate_over_range;
    const double third = 6 * w * w * rate * dt * (dt + ab) * (dt + ab + bc) / 6;
    const double amplified = noise * (1 + 2 * dt / ab) * (1 + dt / bc);
    out.along_rad = out.across_rad = third + amplified;
  }
  out.along = unit(ub - ua);
  return out;
}

/// Chi-square that a fit of `degrees` of freedom exceeds in 1 of 1,000.
double largest_arc_chi2(int degrees) { return chi_square_of_normal(3.09, std::max(1, degrees)); }

double range_sigma(const OrbitEstimate& estimate, const Vec<Gcrs>& sensor_m) {
  const Vec<Gcrs> line = estimate.state.position_m - sensor_m;
  return std::sqrt(estimate.covariance.topLeftCorner<3, 3>().trace()) / norm(line);
}

/// Whether two fits are one orbit within their errors.
bool same_orbit(const BatchFit& a, const BatchFit& b) {
  OrbitState moved = b.estimate.state;
  if (!move_two_body(moved, (a.estimate.state.time - moved.time).seconds())) return false;
  const double sigma_m = std::sqrt(a.estimate.covariance.topLeftCorner<3, 3>().trace());
  return norm(moved.position_m - a.estimate.state.position_m) < 3 * sigma_m;
}

}  // namespace

ArcStart::ArcStart(const ForceModel& forces, const FusionSettings& settings)
    : forces_(forces), settings_(settings) {}

std::vector<ArcStart::Arc> ArcStart::arcs_to(const LooseSource& last,
                                             const std::vector<LooseSource>& earlier) const {
  std::vector<std::uint32_t> exposures;  // frames before the last, the newest first
  for (auto s = earlier.rbegin(); s != earlier.rend(); ++s)
    if (s->frame < last.frame &&
        (seen(last).time - seen(*s).time).seconds() >= shortest_arc_gap_s &&
        (exposures.empty() || exposures.back() != s->frame))
      exposures.push_back(s->frame);
  const auto at = [&](std::uint32_t frame) -> std::span<const LooseSource> {
    const auto first = std::ranges::lower_bound(earlier, frame, {}, &LooseSource::frame);
    const auto end = std::ranges::upper_bound(earlier, frame, {}, &LooseSource::frame);
    return {first, end};
  };
  std::vector<Arc> arcs;
  for (std::size_t first = 0; first < std::min<std::size_t>(exposures.size(), max_skipped); ++first)
    for (const LooseSource& second : at(exposures[first])) {
      const double rate = angle_rad(seen(last).direction, seen(second).direction) /
                          (seen(last).time - seen(second).time).seconds();
      if (!(rate > 0) || rate > fastest_rad_per_s) continue;
      Arc arc{&last, &second};
      int skipped = 0;
      double chance = double(at(exposures[first]).size()) * double(first + 1);
      for (std::size_t k = first + 1; k < exposures.size() && skipped <= max_skipped; ++k) {
        const LooseSource* best = nullptr;
        Continued expected;  // where the best is
        double best_d2 = 1.0;
        for (const LooseSource& s : at(exposures[k])) {
          const Continued there = continued(arc, seen(s).time);
          const Vec<Gcrs> miss = seen(s).direction - there.direction;
          const double along = dot(miss, there.along);
          const double across2 = std::max(0.0, dot(miss, miss) - along * along);
          const double d2 = along * along / (there.along_rad * there.along_rad) +
                            across2 / (there.across_rad * there.across_rad);
          if (d2 < best_d2) best_d2 = d2, best = &s, expected = there;
        }
        if (!best) {
          ++skipped;
          continue;
        }
        arc.push_back(best);
        const double per_sr =
            double(at(exposures[k]).size()) * best->false_per_sr / settings_.false_alarms_per_frame;
        chance *= std::min(1.0, pi * expected.along_rad * expected.across_rad * per_sr) *
                  double(skipped + 1);
        skipped = 0;
      }
      if (int(arc.size()) >= settings_.arc_exposures && chance < most_by_chance)
        arcs.push_back(std::move(arc));
    }
  return arcs;
}

std::optional<StartedOrbit> ArcStart::orbit_of(const std::vector<LooseSource>& arc) const {
  std::vector<AngleObservation> lines;
  for (const LooseSource& s : arc) lines.push_back(seen(s));
  auto fits = one_arc_orbits(forces_, lines, {}, limits);
  if (!fits) return std::nullopt;
  BatchFit& best = fits->front();
  if (best.chi2 > largest_arc_chi2(best.degrees_of_freedom) || !is_sane(best.estimate) ||
      range_sigma(best.estimate, lines.front().sensor_m) > largest_range_sigma)
    return std::nullopt;
  for (const BatchFit& other : *fits)
    if (other.chi2 < best.chi2 + as_likely && !same_orbit(best, other)) return std::nullopt;
  return StartedOrbit{std::move(best), arc};
}

std::vector<StartedOrbit> ArcStart::add(const std::vector<LooseSource>& sources) {
  std::map<std::string, std::vector<LooseSource>> fresh;
  for (const LooseSource& s : sources)
    if (!s.source.star_like) fresh[seen(s).sensor].push_back(s);
  std::vector<std::vector<LooseSource>> arcs;  // by time; copies, for what is kept moves
  for (auto& [sensor, found] : fresh) {
    std::vector<LooseSource>& kept = loose_[sensor];
    std::ranges::sort(found, [](const auto& a, const auto& b) {
      return std::tuple(a.frame, a.source.magnitude, seen(a).detection_id) <
             std::tuple(b.frame, b.source.magnitude, seen(b).detection_id);
    });
    std::size_t of_exposure = 0;
    std::uint32_t exposure = 0;
    for (LooseSource& s : found) {
      of_exposure = s.frame == exposure && of_exposure > 0 ? of_exposure + 1 : 1;
      exposure = s.frame;
      if (of_exposure <= max_per_exposure) kept.push_back(std::move(s));
    }
    std::ranges::sort(kept, [](const auto& a, const auto& b) { return order(a) < order(b); });
    const SimTime newest = seen(kept.back()).time;
    std::erase_if(kept, [&](const LooseSource& s) {
      return (newest - seen(s).time).seconds() > settings_.arc_window_s;
    });
    for (const LooseSource& s : kept) {
      if (s.frame != kept.back().frame) continue;
      for (const Arc& arc : arcs_to(s, kept)) {
        // Not every length of a growing arc is tried: 4, 5, 6, 8, 11, 15, 20, ...
        int wanted = settings_.arc_exposures;
        while (wanted < int(arc.size())) wanted += std::max(1, wanted / 3);
        if (wanted != int(arc.size())) continue;
        std::vector<LooseSource> copy;
        for (auto part = arc.rbegin(); part != arc.rend(); ++part) copy.push_back(**part);
        arcs.push_back(std::move(copy));
      }
    }
  }
  // The longest first.
  std::ranges::stable_sort(arcs, std::ranges::greater(), &std::vector<LooseSource>::size);
  std::vector<StartedOrbit> orbits;
  std::set<std::string> used;
  std::size_t fits = 0;
  for (const auto& arc : arcs) {
    if (std::ranges::any_of(arc,
                            [&](const auto& s) { return used.contains(seen(s).detection_id); }))
      continue;
    if (fits++ == max_fits) break;
    if (auto orbit = orbit_of(arc)) {
      for (const LooseSource& s : arc) used.insert(seen(s).detection_id);
      orbits.push_back(std::move(*orbit));
    }
  }
  return orbits;
}

void ArcStart::forget(const std::vector<std::string>& ids) {
  const std::set<std::string> gone(ids.begin(), ids.end());
  for (auto& [sensor, kept] : loose_)
    std::erase_if(kept, [&](const LooseSource& s) { return gone.contains(seen(s).detection_id); });
}

}  // namespace dmise
