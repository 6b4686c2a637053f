#include "sensors/survey/detection_model.h"

#include <algorithm>
#include <cmath>

#include "core/score/matched_filter.h"

namespace dmise {
namespace {

constexpr double most_probability = 1.0 - 1e-9;

struct Curve {
  double log_half = 0.0, spread = 1.0;
};

Curve curve_at(const DetectionModel& model, double length_px) {
  const auto& nodes = model.lengths;
  const auto of = [](const DetectionModel::Length& l) {
    return Curve{std::log(l.half_snr), l.spread};
  };
  const auto after =
      std::upper_bound(nodes.begin(), nodes.end(), length_px,
                       [](double length, const auto& node) { return length < node.length_px; });
  if (after == nodes.begin()) return of(nodes.front());
  if (after == nodes.end()) return of(nodes.back());
  const auto& a = *(after - 1);
  const double x = std::log2(1.0 + length_px), x0 = std::log2(1.0 + a.length_px);
  const double share = (x - x0) / (std::log2(1.0 + after->length_px) - x0);
  const Curve c0 = of(a), c1 = of(*after);
  return {c0.log_half + share * (c1.log_half - c0.log_half),
          c0.spread + share * (c1.spread - c0.spread)};
}

// Standard deviations of the prior about the start: of ln half, ln spread and the share.
constexpr double prior_half = 0.5, prior_spread = 0.5, prior_share = 0.05;
constexpr double least_spread = 0.02, most_spread = 2.0, least_share = 0.5;

/// Minus the logarithm of the posterior.
double badness(const DetectionModel& model, const DetectionModel& start,
               std::span<const DetectionSample> samples) {
  double sum = 0.0;
  for (const auto& s : samples) {
    const double p = std::clamp(detection_probability(model, s.snr, s.length_px), 1e-9, 1.0 - 1e-9);
    sum -= s.found ? std::log(p) : std::log1p(-p);
  }
  const auto square = [](double x) { return x * x; };
  for (std::size_t k = 0; k < model.lengths.size(); ++k) {
    const auto &m = model.lengths[k], &s = start.lengths[k];
    sum += 0.5 * square(std::log(m.half_snr / s.half_snr) / prior_half) +
           0.5 * square(std::log(m.spread / s.spread) / prior_spread);
  }
  return sum + 0.5 * square((model.share - start.share) / prior_share);
}

/// The least of `of` within [low, high], by golden sections.
template <class Function>
double least_of(double low, double high, const Function& of) {
  const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
  double a = high - golden * (high - low), b = low + golden * (high - low);
  double at_a = of(a), at_b = of(b);
  for (int i = 0; i < 16; ++i) {
    if (at_a < at_b) {
      high = b, b = a, at_b = at_a;
      at_a = of(a = high - golden * (high - low));
    } else {
      low = a, a = b, at_a = at_b;
      at_b = of(b = low + golden * (high - low));
    }
  }
  return 0.5 * (low + high);
}

}  // namespace

double detection_probability(const DetectionModel& model, double snr, double length_px) {
  if (!(snr > 0.0)) return 0.0;
  const Curve curve = curve_at(model, length_px);
  const double sigmas = (std::log(snr) - curve.log_half) / curve.spread;
  return std::min(most_probability, model.share * theory_of_detection(sigmas, 0.0));
}

DetectionModel fitted_detection_model(const DetectionModel& start,
                                      std::span<const DetectionSample> samples) {
  // Far below any threshold there is nothing to learn.
  std::vector<DetectionSample> telling;
  for (const auto& s : samples)
    if (s.snr > 2.0 || s.found) telling.push_back(s);
  DetectionModel model = start;
  constexpr int sweeps = 12;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (auto& node : model.lengths) {
      node.half_snr = std::exp(least_of(std::log(3.0), std::log(300.0), [&](double log_half) {
        node.half_snr = std::exp(log_half);
        return badness(model, start, telling);
      }));
      node.spread = least_of(least_spread, most_spread, [&](double spread) {
        node.spread = spread;
        return badness(model, start, telling);
      });
    }
    model.share = least_of(least_share, 1.0, [&](double share) {
      model.share = share;
      return badness(model, start, telling);
    });
  }
  return model;
}

}  // namespace dmise
