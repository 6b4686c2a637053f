#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/tracking/initial/initial_orbit.h"
#include "core/tracking/initial/lambert.h"

namespace dmise {

namespace {

using Fit = Outcome<BatchFit>;

/// Longest part of a turn between the two places that Lambert's path joins.
constexpr double longest_turn = 0.3;

bool two_sites(std::span<const AngleObservation> lines) {
  return std::any_of(lines.begin(), lines.end(), [&](const AngleObservation& line) {
    return norm(line.sensor_m - lines[0].sensor_m) > 100.0 && line.sensor != lines[0].sensor;
  });
}

/// Positions from observations that are sorted by time. `reason` is that of the last refusal.
std::vector<TriangulatedPosition> positions_of(std::span<const AngleObservation> sorted,
                                               const TriangulationSettings& settings,
                                               std::string_view& reason) {
  std::vector<TriangulatedPosition> out;
  reason = "no two sites saw it at about the same time";
  for (std::size_t begin = 0; begin < sorted.size();) {
    std::size_t end = begin + 1;
    while (end < sorted.size() &&
           (sorted[end].time - sorted[begin].time).seconds() <= settings.longest_s)
      ++end;
    const auto lines = sorted.subspan(begin, end - begin);
    if (!two_sites(lines)) {
      ++begin;
      continue;
    }
    const auto position = triangulate(lines, {}, settings);
    if (position)
      out.push_back(*position);
    else
      reason = position.reason;
    begin = end;
  }
  return out;
}

/// Time of one turn on a circle [s].
double turn_s(const Vec<Gcrs>& position_m) {
  const double r = norm(position_m);
  return 2 * pi * std::sqrt(r * r * r / earth_gm_m3_per_s2);
}

}  // namespace

Outcome<BatchFit> two_site_orbit(const ForceModel& forces,
                                 std::span<const AngleObservation> observations,
                                 const TriangulationSettings& triangulation,
                                 const BatchSettings& batch) {
  std::vector<AngleObservation> sorted(observations.begin(), observations.end());
  for (const AngleObservation& o : sorted)
    if (const auto fault = fault_of(o); !fault.empty()) return Fit::refused(fault);
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.time < b.time; });
  std::string_view reason;
  const auto positions = positions_of(sorted, triangulation, reason);
  if (positions.empty()) return Fit::refused(reason);
  const TriangulatedPosition& first = positions.front();
  const TriangulatedPosition* second = nullptr;
  for (const TriangulatedPosition& p : positions)
    if ((p.time - first.time).seconds() <= longest_turn * turn_s(first.position_m)) second = &p;
  if (second == &first) {
    if (positions.size() == 1)
      return Fit::refused("two sites saw it together only once: its velocity is not known");
    return Fit::refused("the times at which two sites saw it are too far apart");
  }
  // Less than half a turn: the path turns the short way.
  LambertSettings lamberts;
  lamberts.normal = cross(first.position_m, second->position_m);
  const auto paths = lambert(first.position_m, second->position_m,
                             (second->time - first.time).seconds(), lamberts);
  if (!paths) return Fit::refused(paths.reason);
  OrbitState start{first.time, first.position_m, paths->front().start_velocity_m_per_s};
  // The arc between both positions first, then all.
  std::vector<AngleObservation> between;
  const SimTime last = second->time + sim_seconds(triangulation.longest_s + 1);
  for (const AngleObservation& o : sorted)
    if (o.time <= last) between.push_back(o);
  if (between.size() < sorted.size()) {
    BatchSettings simple;
    simple.huber_sigma = batch.huber_sigma;
    simple.propagation = batch.propagation;
    const auto arc = fit_orbit(forces, between, start, simple);
    if (arc) {
      start.position_m = arc->estimate.state.position_m;
      start.velocity_m_per_s = arc->estimate.state.velocity_m_per_s;
    }
  }
  return fit_orbit(forces, observations, start, batch);
}

}  // namespace dmise
