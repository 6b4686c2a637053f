#include "core/score/association.h"

#include "core/base/numeric/assignment.h"
#include "core/score/trail.h"

namespace dmise {
namespace {

struct Pair {
  std::size_t detection = 0;
  double cost = 0.0;  // squared normalised distance
};

/// Whether at least half of a detection's line is near the trail.
bool lies_on(const Detection& d, const TrueTrail& trail, double gate_px) {
  const PixelPosition centroid{d.x_px, d.y_px};
  if (!trail.may_be_near(centroid, gate_px) || trail.nearest(centroid).distance_px > gate_px)
    return false;
  if (d.length_px <= 0.0) return true;
  const TrueTrail line({d.end1_x_px, d.end1_y_px}, centroid, {d.end2_x_px, d.end2_y_px});
  constexpr int samples = 33;
  int near = 0;
  for (int k = 0; k < samples; ++k)
    near += trail.nearest(line.at(double(k) / (samples - 1))).distance_px <= gate_px;
  return 2 * near >= samples;
}

std::vector<std::vector<Pair>> possible_pairs(std::span<const TrueSource> truths,
                                              std::span<const FoundSource> detections,
                                              double gate_px) {
  std::vector<std::vector<Pair>> pairs(truths.size());
  for (std::size_t t = 0; t < truths.size(); ++t) {
    if (!truths[t].light) continue;
    const TrueTrail trail(truths[t].start, truths[t].middle, truths[t].end);
    const double light_px = trail.nearest(*truths[t].light).along_px;
    for (std::size_t k = 0; k < detections.size(); ++k) {
      const Detection& d = detections[k].detection;
      if (!lies_on(d, trail, gate_px)) continue;
      const auto nearest = trail.nearest({d.x_px, d.y_px});
      const double across = nearest.distance_px / gate_px;
      const double along = (nearest.along_px - light_px) / (0.5 * trail.length_px() + gate_px);
      pairs[t].push_back({k, across * across + along * along});
    }
  }
  return pairs;
}

/// The detection of each truth, or `unassigned`: of the assignments with most pairs the one with
/// the least sum of costs.
std::vector<std::size_t> assigned(const std::vector<std::vector<Pair>>& pairs,
                                  std::size_t detections) {
  double sum = 1.0;
  for (const auto& of_truth : pairs)
    for (const Pair& pair : of_truth) sum += pair.cost;
  std::vector<Pairing> possible;  // one more pair is worth more than all costs together
  for (std::size_t t = 0; t < pairs.size(); ++t)
    for (const Pair& pair : pairs[t]) possible.push_back({t, pair.detection, pair.cost - sum});
  return assign(pairs.size(), detections, possible);
}

}  // namespace

Association associate(std::span<const TrueSource> truths, std::span<const FoundSource> detections,
                      double gate_px) {
  const auto pairs = possible_pairs(truths, detections, gate_px);
  const auto assignment = assigned(pairs, detections.size());
  Association out;
  out.detection_of_truth.resize(truths.size());
  out.pieces_of_truth.resize(truths.size());
  std::vector<bool> taken(detections.size(), false);
  for (std::size_t t = 0; t < truths.size(); ++t)
    if (const std::size_t k = assignment[t]; k != unassigned)
      out.detection_of_truth[t] = k, taken[k] = true;
  for (std::size_t k = 0; k < detections.size(); ++k) {
    if (taken[k]) continue;
    // The nearest of the truths that it may be a piece of.
    std::size_t best = truths.size();
    double least = 0.0;
    for (std::size_t t = 0; t < truths.size(); ++t)
      for (const Pair& pair : pairs[t])
        if (pair.detection == k && (best == truths.size() || pair.cost < least))
          best = t, least = pair.cost;
    if (best < truths.size())
      out.pieces_of_truth[best].push_back(k);
    else
      out.false_alarms.push_back(k);
  }
  return out;
}

}  // namespace dmise
