#include "sensors/survey/detection_model.h"

#include <algorithm>
#include <cmath>

#include "core/base/numeric/golden_section.h"
#include "core/detection/pixels/detection_limits.h"
#include "core/score/matched_filter.h"

namespace dmise {
namespace {

constexpr double max_probability = 1.0 - 1e-9;

struct DetectionCurve {
  double half = 1.0, spread = 1.0;

  double sigmas(double snr) const { return std::log(snr / half) / spread; }
};

/// Where `share` is 0 `a`, where it is 1 `b`.
DetectionCurve mixed(const DetectionCurve& a, const DetectionCurve& b, double share) {
  return {std::pow(a.half, 1.0 - share) * std::pow(b.half, share),
          a.spread + share * (b.spread - a.spread)};
}

/// Share of the way from `low` to `high`, [0, 1].
double way(double low, double high, double x) {
  return std::clamp((x - low) / (high - low), 0.0, 1.0);
}

double log_px(double px) { return std::log2(1.0 + px); }

DetectionCurve curve_at(const std::vector<DetectionModel::Node>& nodes, double px) {
  const auto after = std::upper_bound(nodes.begin(), nodes.end(), px,
                                      [](double x, const auto& node) { return x < node.px; });
  if (after == nodes.begin()) return {nodes.front().half_snr, nodes.front().spread};
  if (after == nodes.end()) return {nodes.back().half_snr, nodes.back().spread};
  const auto& a = *(after - 1);
  return mixed({a.half_snr, a.spread}, {after->half_snr, after->spread},
               way(log_px(a.px), log_px(after->px), log_px(px)));
}

double among_trails(const ExpectedTrail& trail) {
  return way(DetectionModel::round_px, DetectionModel::trailed_px, trail.star_px);
}

double among_far_trails(const ExpectedTrail& trail) {
  return way(DetectionModel::long_px, DetectionModel::far_px, trail.star_px);
}

/// How far a trail is from a point: 0 of one, 1 from `row_px` on.
double longer_than_point(const ExpectedTrail& trail) {
  return way(log_px(DetectionModel::point_px), log_px(DetectionModel::row_px),
             log_px(trail.length_px));
}

/// By the trail's length.
DetectionCurve curve_of(const DetectionModel& model, const ExpectedTrail& trail) {
  using M = DetectionModel;
  const DetectionCurve usual = curve_at(model.trailed, trail.length_px);
  const DetectionCurve row = curve_at(model.trailed, std::max(trail.length_px, M::row_px));
  const DetectionCurve far = model.far.empty() ? row
                                               : mixed(curve_at(model.far, trail.length_px), row,
                                                       longer_than_point(trail));
  const DetectionCurve among_long = mixed(row, far, among_far_trails(trail));
  const DetectionCurve among_round =
      curve_at(trail.star_known ? model.round_known : model.round, trail.length_px);
  return mixed(among_round, mixed(usual, among_long, way(M::trailed_px, M::long_px, trail.star_px)),
               among_trails(trail));
}

double share_of(const DetectionModel& model, const ExpectedTrail& trail) {
  const double points = std::lerp(model.share_points, model.share_far, among_far_trails(trail));
  const double share = std::lerp(points, model.share, longer_than_point(trail));
  return std::lerp(model.share_round, share, among_trails(trail));
}

// Standard deviations of the prior about the start: of ln half, ln spread and the share.
constexpr double prior_half = 0.5, prior_spread = 0.5, prior_share = 0.05;
constexpr double min_spread = 0.02, max_spread = 2.0, min_share = 0.5;

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
  for (std::size_t k = 0; k < model.shares().size(); ++k)
    sum += 0.5 * square((*model.shares()[k] - *start.shares()[k]) / prior_share);
  return sum;
}

/// Where a function is least within [low, high].
template <class Function>
double least_of(double low, double high, const Function& of) {
  return golden_section(of, low, high, 5e-4 * (high - low)).at;
}

}  // namespace

double shape_difference_px(const ExpectedTrail& trail) {
  const auto square = [](double x) { return x * x; };
  const double length = trail.length_px, star = trail.star_px;
  // Second moments of a trail are its vector's dyad / 12, so their difference has the norm of the
  // square of a length. Trails have no direction.
  const double product = std::min(
      0.5 * std::abs(square(length) + square(star) - square(trail.unlike_px)), length * star);
  const double moments_px = std::sqrt(std::sqrt(
      std::max(0.0, square(square(length)) + square(square(star)) - 2.0 * square(product))));
  // What is almost a point is compared with a star as one.
  constexpr double as_point_px = 0.8, falls_by = 2.0;
  const double as_point = star - falls_by * std::max(0.0, length - as_point_px);
  constexpr double min_px = detection_limits::min_difference_px, steepness = 4.0;
  const double allowed_px = min_px + steepness * (std::max(trail.unlike_px, as_point) - min_px);
  return std::max(0.0, std::min(moments_px, allowed_px));
}

double detection_probability(const DetectionModel& model, const ExpectedTrail& trail) {
  if (!(trail.snr > 0.0)) return 0.0;
  double sigmas = curve_of(model, trail).sigmas(trail.snr);
  if (!trail.star_known && !model.shape.empty())
    sigmas = std::min(sigmas, curve_at(model.shape, shape_difference_px(trail)).sigmas(trail.snr));
  return std::min(max_probability, share_of(model, trail) * theory_of_detection(sigmas, 0.0));
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
        node.spread = least_of(min_spread, max_spread, [&](double spread) {
          node.spread = spread;
          return badness(model, start, telling);
        });
      }
    for (double* share : model.shares())
      *share = least_of(min_share, 1.0, [&](double value) {
        *share = value;
        return badness(model, start, telling);
      });
  }
  return model;
}

}  // namespace dmise
