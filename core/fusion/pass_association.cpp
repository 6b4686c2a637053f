#include "core/fusion/pass_association.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/fusion/frame_pairs.h"
#include "core/tracking/propagate.h"

namespace dmise {
namespace {

constexpr PropagationSettings pass_steps{.position_tolerance_m = 1e-2};
constexpr double max_part_s = 900.0;  // longest part of a pass that the simpler forces predict

/// Innovation of a source in the dimensions that are compared.
struct Match {
  double d2 = 0.0, spread = 0.0;
};

Match match_of(const PredictedMotion& predicted, const SeenMotion& seen, bool rates) {
  if (rates) {
    const MotionInnovation found = innovation_of(predicted, seen);
    return {found.d2, found.spread};
  }
  const Innovation found = innovation_of(predicted.direction, seen.observation);
  return {found.d2,
          std::log((2 * pi) * (2 * pi) * std::max(found.covariance_rad2.determinant(), 1e-300))};
}

/// Adds to an arc what one exposure shows of the object `predicted`.
void take_exposure(const PassExposure& exposure, const PredictedMotion& predicted,
                   const PassAssociationSettings& settings, PassArc& arc) {
  std::vector<PredictedMotion> all{predicted};
  for (const OrbitEstimate& other : exposure.others)
    all.push_back(predict_motion(other, exposure.sensor_m, exposure.sensor_m_per_s, exposure.time));
  const double rates = pi * settings.max_rate_rad_per_s * settings.max_rate_rad_per_s;
  FramePairs pairs(settings.detection_probability,
                   settings.rates ? settings.false_per_sr / rates : settings.false_per_sr);
  const double gate_d2 = settings.rates ? settings.motion_gate_d2 : settings.direction_gate_d2;
  for (std::size_t row = 0; row < exposure.sources.size(); ++row) {
    const SeenMotion& seen = exposure.sources[row];
    if (angle_rad(seen.observation.direction, predicted.direction.direction) >
        exposure.half_angle_rad)
      continue;
    for (std::size_t k = 0; k < all.size(); ++k)
      if (const Match m = match_of(all[k], seen, settings.rates); m.d2 < gate_d2)
        pairs.add(row, k, m.d2, m.spread, 1.0);
  }
  const auto columns = pairs.assigned(exposure.sources.size(), all.size());
  const auto others = pairs.others(columns);
  for (std::size_t row = 0; row < columns.size(); ++row) {
    if (columns[row] != 0) continue;
    if (pairs.likelihood(row, 0) < settings.min_odds * others[row])
      ++arc.ambiguous;
    else
      arc.observations.push_back(exposure.sources[row].observation);
  }
}

}  // namespace

Outcome<PassArc> associate_pass(const ForceModel& forces, const OrbitEstimate& estimate,
                                std::span<const PassExposure> exposures,
                                const PassAssociationSettings& settings) {
  using Result = Outcome<PassArc>;
  PassArc out;
  OrbitEstimate now = estimate;
  for (const PassExposure& exposure : exposures) {
    if (now.state.time < exposure.time) {
      const auto moved = propagate(forces, now, exposure.time, pass_steps);
      if (!moved) return Result::refused(moved.reason);
      now = *moved;
    }
    take_exposure(exposure,
                  predict_motion(now, exposure.sensor_m, exposure.sensor_m_per_s, exposure.time),
                  settings, out);
  }
  return out;
}

Outcome<PassArc> associate_pass(const MaintenanceForces& forces, const CatalogueObject& object,
                                std::span<const PassExposure> exposures,
                                const PassAssociationSettings& settings) {
  PassArc all;
  while (!exposures.empty()) {
    const SimTime begin = exposures.front().time, end = begin + sim_seconds(max_part_s);
    const auto beyond =
        std::ranges::find_if(exposures, [&](const PassExposure& e) { return end < e.time; });
    const auto part = exposures.first(std::size_t(beyond - exposures.begin()));
    exposures = exposures.subspan(part.size());
    const auto expected = object.estimate_at(begin);
    if (!expected) return Outcome<PassArc>::refused(expected.reason);
    auto arc = associate_pass(forces.derivatives(), *expected, part, settings);
    if (arc && arc->observations.empty() && settings.manoeuvre_m_per_s > 0) {
      const auto last = object.estimate_at(object.time());
      if (!last) return Outcome<PassArc>::refused(last.reason);
      const auto led =
          move_on(forces, perhaps_manoeuvred(*last, settings.manoeuvre_m_per_s), begin);
      if (!led) return Outcome<PassArc>::refused(led.reason);
      arc = associate_pass(forces.derivatives(), *led, part, settings);
      all.after_a_manoeuvre = all.after_a_manoeuvre || (arc && !arc->observations.empty());
    }
    if (!arc) return arc;
    all.ambiguous += arc->ambiguous;
    all.observations.insert(all.observations.end(), arc->observations.begin(),
                            arc->observations.end());
  }
  return all;
}

}  // namespace dmise
