#include "core/score/association.h"

#include <limits>
#include <queue>

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

/// The largest one-to-one assignment with the least sum of costs: truths enter one at a time, each
/// by the shortest augmenting path (Bellman and Ford, since the way back along a taken pair has a
/// negative cost).
class Assignment {
 public:
  Assignment(const std::vector<std::vector<Pair>>& pairs, std::size_t detections)
      : pairs_(pairs), truth_of_(detections, none), detection_of_(pairs.size(), none) {
    while (augment()) {
    }
  }
  const std::vector<std::size_t>& detection_of() const { return detection_of_; }
  static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

 private:
  bool augment() {
    constexpr double far = std::numeric_limits<double>::infinity();
    std::vector<double> to_truth(pairs_.size(), far), to_detection(truth_of_.size(), far);
    std::vector<std::size_t> from(truth_of_.size(), none);
    std::queue<std::size_t> open;
    std::vector<bool> queued(pairs_.size(), false);
    for (std::size_t t = 0; t < pairs_.size(); ++t)
      if (detection_of_[t] == none && !pairs_[t].empty()) to_truth[t] = 0.0, open.push(t);
    while (!open.empty()) {
      const std::size_t t = open.front();
      open.pop();
      queued[t] = false;
      for (const Pair& pair : pairs_[t]) {
        const double cost = to_truth[t] + pair.cost;
        if (detection_of_[t] == pair.detection || cost >= to_detection[pair.detection] - 1e-12)
          continue;
        to_detection[pair.detection] = cost;
        from[pair.detection] = t;
        const std::size_t next = truth_of_[pair.detection];
        if (next == none) continue;
        to_truth[next] = cost - cost_of(next, pair.detection);
        if (!queued[next]) open.push(next), queued[next] = true;
      }
    }
    std::size_t end = none;
    for (std::size_t k = 0; k < truth_of_.size(); ++k)
      if (truth_of_[k] == none && to_detection[k] < far &&
          (end == none || to_detection[k] < to_detection[end]))
        end = k;
    if (end == none) return false;
    while (end != none) {
      const std::size_t t = from[end], before = detection_of_[t];
      truth_of_[end] = t;
      detection_of_[t] = end;
      end = before;
    }
    return true;
  }
  double cost_of(std::size_t truth, std::size_t detection) const {
    for (const Pair& pair : pairs_[truth])
      if (pair.detection == detection) return pair.cost;
    return 0.0;
  }

  const std::vector<std::vector<Pair>>& pairs_;
  std::vector<std::size_t> truth_of_, detection_of_;
};

}  // namespace

Association associate(std::span<const TrueSource> truths, std::span<const FoundSource> detections,
                      double gate_px) {
  const auto pairs = possible_pairs(truths, detections, gate_px);
  const Assignment assignment(pairs, detections.size());
  Association out;
  out.detection_of_truth.resize(truths.size());
  out.pieces_of_truth.resize(truths.size());
  std::vector<bool> taken(detections.size(), false);
  for (std::size_t t = 0; t < truths.size(); ++t)
    if (const std::size_t k = assignment.detection_of()[t]; k != Assignment::none)
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
