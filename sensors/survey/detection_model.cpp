#include "sensors/survey/detection_model.h"

#include <algorithm>
#include <cmath>

#include "core/base/golden_section.h"
#include "core/detection/detection_limits.h"
#include "core/score/matched_filter.h"

namespace dmise {
namespace {

constexpr double most_probability = 1.0 - 1e-9;

struct Curve {
  double half = 1.0, spread = 1.0, share = 1.0;
};

Curve curve_at(const std::vector<DetectionModel::Node>& nodes, double px) {
  const auto after = std::upper_bound(nodes.begin(), nodes.end(), px,
                                      [](double x, const auto& node) { return x < node.px; });
  if (after == nodes.begin()) return {nodes.front().half_snr, nodes.front().spread};
  if (after == nodes.end()) return {nodes.back().half_snr, nodes.back().spread};
  const auto& a = *(after - 1);
  const double x = std::log2(1.0 + px), x0 = std::log2(1.0 + a.px);
  const double share = (x - x0) / (std::log2(1.0 + after->px) - x0);
  return {a.half_snr * std::pow(after->half_snr / a.half_snr, share),
          a.spread + share * (after->spread - a.spread)};
}

/// The length that a trail counts as among stars that trail: where they trail by more than where
/// detection was measured, the more it differs from them the longer.
double length_among_trails_px(const ExpectedTrail& trail) {
  constexpr double longer_by = 4.0;  // for each pixel of a longer star's trail
  if (trail.unlike_px < detection_limits::least_difference_px) return trail.length_px;
  const double beyond_px = trail.star_px - DetectionModel::usual_star_px;
  return std::max(
      {trail.length_px, trail.unlike_px - DetectionModel::usual_star_px, longer_by * beyond_px});
}

Curve curve_of(const DetectionModel& model, const ExpectedTrail& trail) {
  using M = DetectionModel;
  const Curve among_trails = curve_at(model.trailed, length_among_trails_px(trail));
  const Curve among_round =
      curve_at(trail.star_known ? model.round_known : model.round, trail.length_px);
  const double share =
      std::clamp((trail.star_px - M::round_px) / (M::trailed_px - M::round_px), 0.0, 1.0);
  return {std::pow(among_trails.half, share) * std::pow(among_round.half, 1.0 - share),
          share * among_trails.spread + (1.0 - share) * among_round.spread,
          share * model.share + (1.0 - share) * model.share_round};
}

// Standard deviations of the prior about the start: of ln half, ln spread and the share.
constexpr double prior_half = 0.5, prior_spread = 0.5, prior_share = 0.05;
constexpr double least_spread = 0.02, most_spread = 2.0, least_share = 0.5;

/// Minus the logarithm of the posterior.
double badness(const DetectionModel& model, const DetectionModel& start,
               std::span<const DetectionSample> samples) {
  double sum = 0.0;
  for (const auto& s : samples) {
    const double p = std::clamp(detection_probability(model, s.trail), 1e-9, 1.0 - 1e-9);
    sum -= s.found ? std::log(p) : std::log1p(-p);
  }
  const auto square = [](double x) { return x * x; };
  for (std::size_t list = 0; list < model.nodes().size(); ++list)
    for (std::size_t k = 0; k < model.nodes()[list]->size(); ++k) {
      const auto &m = (*model.nodes()[list])[k], &s = (*start.nodes()[list])[k];
      sum += 0.5 * square(std::log(m.half_snr / s.half_snr) / prior_half) +
             0.5 * square(std::log(m.spread / s.spread) / prior_spread);
    }
  return sum + 0.5 * square((model.share - start.share) / prior_share) +
         0.5 * square((model.share_round - start.share_round) / prior_share);
}

/// Where a function is least within [low, high].
template <class Function>
double least_of(double low, double high, const Function& of) {
  return golden_section(of, low, high, 5e-4 * (high - low)).at;
}

}  // namespace

double detection_probability(const DetectionModel& model, const ExpectedTrail& trail) {
  if (!(trail.snr > 0.0)) return 0.0;
  const Curve curve = curve_of(model, trail);
  const double sigmas = std::log(trail.snr / curve.half) / curve.spread;
  return std::min(most_probability, curve.share * theory_of_detection(sigmas, 0.0));
}

DetectionModel fitted_detection_model(const DetectionModel& start,
                                      std::span<const DetectionSample> samples) {
  // Far below any threshold there is nothing to learn.
  std::vector<DetectionSample> telling;
  for (const auto& s : samples)
    if (s.trail.snr > 2.0 || s.found) telling.push_back(s);
  DetectionModel model = start;
  constexpr int sweeps = 12;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (auto* nodes : model.nodes())
      for (auto& node : *nodes) {
        node.half_snr = std::exp(least_of(std::log(3.0), std::log(300.0), [&](double log_half) {
          node.half_snr = std::exp(log_half);
          return badness(model, start, telling);
        }));
        node.spread = least_of(least_spread, most_spread, [&](double spread) {
          node.spread = spread;
          return badness(model, start, telling);
        });
      }
    for (double* share : {&model.share, &model.share_round})
      *share = least_of(least_share, 1.0, [&](double value) {
        *share = value;
        return badness(model, start, telling);
      });
  }
  return model;
}

}  // namespace dmise
