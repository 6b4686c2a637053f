#include "core/score/sensor_tally.h"

#include <cmath>

#include "core/score/matched_filter.h"

namespace dmise {
namespace {

std::vector<Bin> bins(const std::vector<double>& edges) {
  std::vector<Bin> out(edges.size() + 1);
  for (std::size_t k = 0; k < edges.size(); ++k) out[k].to = out[k + 1].from = edges[k];
  return out;
}

}  // namespace

SensorTally::SensorTally(const std::string& sensor, const ScoreSettings& settings)
    : settings_(settings) {
  score_.sensor = sensor;
  score_.by_snr = bins({1, 2, 3, 4, 5, 6, 7, 8, 10, 12, 15, 20, 30, 50, 100, 300, 1000});
  score_.by_magnitude = bins({0, 2, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 20});
  score_.by_length_px = bins({2, 5, 10, 20, 50, 100, 200, 300, 500, 1000, 2000});
  score_.by_rate = bins({1, 3, 10, 30, 100, 200, 500, 1000, 2000, 5000, 10000});
}

void SensorTally::add(const ScoredFrame& frame) {
  ++score_.frames;
  if (frame.searched)
    score_.megapixels += 1e-6 * frame.columns * frame.rows;
  else
    ++score_.unsearched_frames;
}

void SensorTally::add(const FoundSource&, bool scored) {
  ++score_.detections;
  if (!scored) ++score_.unscored_detections;
}

void SensorTally::add(const ScoredTruth& t) {
  ++score_.truths;
  ++score_.fates[std::size_t(t.fate)];
  if (t.pieces > 1) ++score_.in_pieces, score_.further_pieces += t.pieces - 1;
  if (!t.has_light()) return;
  add_to(score_.by_snr, t.snr, t);
  add_to(score_.by_magnitude, t.truth.magnitude, t);
  if (t.snr && std::abs(*t.snr - settings_.threshold_snr) <= 4.0)
    trials_[!t.is_point()].push_back({*t.snr, t.fate == Fate::found});
  if (t.is_above(settings_.threshold_snr)) {
    add_to(above_, 0.0, t);
    add_to(score_.by_length_px, t.length_px, t);
    add_to(score_.by_rate, t.rate_arcsec_per_s, t);
  }
  for (const bool all : {false, true}) {
    if (!all && !t.clean) continue;
    for (std::size_t k = 0; k < error_keys.size(); ++k) {
      const auto value = t.errors.*error_keys[k].value;
      if (!value) continue;
      ErrorFigure& figure = score_.errors[all][!t.is_point()][k];
      ++figure.count;
      figure.mean += *value;
      figure.rms += *value * *value;
    }
  }
}

void SensorTally::add_to(std::vector<Bin>& bins, std::optional<double> value,
                         const ScoredTruth& t) const {
  if (!value) return;
  std::size_t k = 0;
  while (bins[k].to && *value >= *bins[k].to) ++k;
  ++bins[k].truths;
  bins[k].found += t.fate == Fate::found;
  if (t.snr)
    bins[k].theory =
        bins[k].theory.value_or(0.0) + theory_of_detection(*t.snr, settings_.threshold_snr);
}

SensorScore SensorTally::finish() {
  for (auto* bins :
       {&score_.by_snr, &score_.by_magnitude, &score_.by_length_px, &score_.by_rate, &above_}) {
    if (bins != &above_) std::erase_if(*bins, [](const Bin& bin) { return bin.truths == 0; });
    for (Bin& bin : *bins) {
      bin.probability = wilson_interval(bin.found, bin.truths);
      if (bin.theory) *bin.theory /= double(bin.truths);
    }
  }
  score_.detection = above_[0];
  score_.points_threshold = fitted_threshold(trials_[0]);
  score_.streaks_threshold = fitted_threshold(trials_[1]);
  for (auto& kinds : score_.errors)
    for (auto& figures : kinds)
      for (ErrorFigure& f : figures)
        if (f.count > 0) f.mean /= double(f.count), f.rms = std::sqrt(f.rms / double(f.count));
  // What is neither the detection of a truth nor a further piece of one.
  score_.false_alarms = score_.detections - score_.unscored_detections - score_.further_pieces -
                        score_.fates[std::size_t(Fate::found)];
  return score_;
}

}  // namespace dmise
