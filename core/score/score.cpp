#include "core/score/score.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/score/association.h"
#include "core/score/match_errors.h"
#include "core/score/matched_filter.h"
#include "core/score/trail.h"

namespace dmise {
namespace {

using FrameKey = std::tuple<std::string, std::size_t, std::string>;  // "9" before "10"

template <class Record>
FrameKey key_of(const Record& r) {
  return {r.sensor, r.frame.size(), r.frame};
}

ScoredTruth known(const TrueSource& truth, const ScoredFrame* frame) {
  ScoredTruth t{.truth = truth};
  if (!frame || !frame->searched) return t;
  const Trail trail(truth.start, truth.middle, truth.end);
  t.length_px = trail.length_inside_px(frame->columns, frame->rows);
  const bool enters = t.length_px > 0.0 || is_inside(truth.middle, frame->columns, frame->rows);
  t.fate = truth.light ? Fate::missed : enters ? Fate::dark : Fate::outside;
  if (frame->exposure_s > 0.0 && frame->scale_rad_per_px > 0.0)
    t.rate_arcsec_per_s = trail.length_px() * frame->scale_rad_per_px / arcsec / frame->exposure_s;
  if (truth.light && truth.signal_e && frame->noise_e && frame->sigma_px)
    t.snr = matched_filter_snr({*truth.signal_e, t.length_px, *frame->noise_e, *frame->sigma_px});
  return t;
}

bool above(const ScoredTruth& t, const ScoreSettings& settings) {
  return t.has_light() && (!t.snr || *t.snr >= settings.threshold_snr);
}

void judge_frame(const ScoredFrame& frame, std::span<ScoredTruth> truths,
                 std::span<const FoundSource> detections, Score& score) {
  std::vector<TrueSource> sources;
  for (const ScoredTruth& t : truths) sources.push_back(t.truth);
  const Association pairs = associate(sources, detections, score.settings.gate_px);
  for (std::size_t k = 0; k < truths.size(); ++k) {
    ScoredTruth& t = truths[k];
    if (const auto found = pairs.detection_of_truth[k]) {
      const Detection& d = detections[*found].detection;
      t.fate = Fate::found;
      t.detection = d;
      t.pieces = 1 + pairs.pieces_of_truth[k].size();
      t.clean = t.truth.whole && !t.truth.resolved && t.pieces == 1 && !d.saturated && !d.at_edge;
      t.errors = errors_of(t, d, frame);
    } else if (t.fate == Fate::missed && !above(t, score.settings)) {
      t.fate = Fate::faint;
    }
  }
  for (const std::size_t k : pairs.false_alarms) score.false_alarms.push_back(detections[k]);
}

std::vector<Bin> bins(std::vector<double> edges) {
  std::vector<Bin> out(edges.size() + 1);
  for (std::size_t k = 0; k < edges.size(); ++k) out[k].to = out[k + 1].from = edges[k];
  return out;
}

void add_to(std::vector<Bin>& bins, std::optional<double> value, const ScoredTruth& t,
            const ScoreSettings& settings) {
  if (!value) return;
  for (Bin& bin : bins) {
    if (bin.to && *value >= *bin.to) continue;
    ++bin.truths;
    bin.found += t.fate == Fate::found;
    if (t.snr)
      bin.theory = bin.theory.value_or(0.0) + theory_of_detection(*t.snr, settings.threshold_snr);
    return;
  }
}

void finish(std::vector<Bin>& bins) {
  std::erase_if(bins, [](const Bin& bin) { return bin.truths == 0; });
  for (Bin& bin : bins) {
    bin.probability = wilson_interval(bin.found, bin.truths);
    if (bin.theory) *bin.theory /= double(bin.truths);
  }
}

SensorScore summary(const Score& score, const ScoreInput& input, const std::string& sensor,
                    const std::map<FrameKey, const ScoredFrame*>& frames) {
  const auto is_of = [&](const auto& r) { return sensor.empty() || r.sensor == sensor; };
  const auto& settings = score.settings;
  SensorScore s{.sensor = sensor};
  for (const ScoredFrame& f : input.frames) {
    if (!is_of(f)) continue;
    ++s.frames;
    if (f.searched)
      s.megapixels += 1e-6 * f.columns * f.rows;
    else
      ++s.unsearched_frames;
  }
  for (const FoundSource& d : input.detections) {
    if (!is_of(d)) continue;
    ++s.detections;
    const auto frame = frames.find(key_of(d));
    s.unscored_detections += frame == frames.end() || !frame->second->searched;
  }
  s.false_alarms = std::size_t(std::ranges::count_if(score.false_alarms, is_of));
  s.by_snr = bins({1, 2, 3, 4, 5, 6, 7, 8, 10, 12, 15, 20, 30, 50, 100, 300, 1000});
  s.by_magnitude = bins({0, 2, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 20});
  s.by_length_px = bins({2, 5, 10, 20, 50, 100, 200, 300, 500, 1000, 2000});
  s.by_rate = bins({1, 3, 10, 30, 100, 200, 500, 1000, 2000, 5000, 10000});
  std::vector<Bin> one(1);
  std::vector<DetectionTrial> trials[2];
  for (const ScoredTruth& t : score.truths) {
    if (!is_of(t.truth)) continue;
    ++s.truths;
    ++s.fates[std::size_t(t.fate)];
    if (t.pieces > 1) ++s.in_pieces, s.further_pieces += t.pieces - 1;
    if (!t.has_light()) continue;
    add_to(s.by_snr, t.snr, t, settings);
    add_to(s.by_magnitude, t.truth.magnitude, t, settings);
    if (t.snr && std::abs(*t.snr - settings.threshold_snr) <= 4.0)
      trials[!t.is_point()].push_back({*t.snr, t.fate == Fate::found});
    if (above(t, settings)) {
      add_to(one, 0.0, t, settings);
      add_to(s.by_length_px, t.length_px, t, settings);
      add_to(s.by_rate, t.rate_arcsec_per_s, t, settings);
    }
    for (const bool all : {false, true}) {
      if (!all && !t.clean) continue;
      for (std::size_t k = 0; k < error_keys.size(); ++k) {
        ErrorFigure& figure = s.errors[all][!t.is_point()][k];
        if (const auto value = t.errors.*error_keys[k].value) {
          ++figure.count;
          figure.mean += *value;
          figure.rms += *value * *value;
        }
      }
    }
  }
  for (auto* list : {&s.by_snr, &s.by_magnitude, &s.by_length_px, &s.by_rate, &one}) finish(*list);
  s.detection = one.empty() ? Bin{.probability = {0.0, 1.0}} : one[0];
  s.points_threshold = fitted_threshold(trials[0]);
  s.streaks_threshold = fitted_threshold(trials[1]);
  for (auto& kinds : s.errors)
    for (auto& figures : kinds)
      for (ErrorFigure& f : figures)
        if (f.count > 0) f.mean /= double(f.count), f.rms = std::sqrt(f.rms / double(f.count));
  return s;
}

}  // namespace

Score score(ScoreInput input, const ScoreSettings& settings) {
  // A total order, so that sums do not depend on that of the lines.
  std::ranges::sort(input.frames, {}, key_of<ScoredFrame>);
  std::ranges::sort(input.truths, {},
                    [](const TrueSource& t) { return std::tuple(key_of(t), t.id); });
  std::ranges::sort(input.detections, {}, [](const FoundSource& d) {
    return std::tuple(key_of(d), d.detection.index, d.detection.id);
  });
  Score out{.settings = settings, .source = input.source, .status = input.status};
  std::map<FrameKey, const ScoredFrame*> frames;
  for (const ScoredFrame& f : input.frames)
    if (!frames.emplace(key_of(f), &f).second)
      throw Error(input.source + ": frame " + f.frame + " of " + f.sensor + " is there twice");
  const auto frame_of = [&](const auto& r) {
    const auto found = frames.find(key_of(r));
    return found == frames.end() ? nullptr : found->second;
  };
  for (const TrueSource& t : input.truths) out.truths.push_back(known(t, frame_of(t)));
  for (const ScoredFrame& frame : input.frames) {
    if (!frame.searched) continue;
    const auto truths = std::ranges::equal_range(
        out.truths, key_of(frame), {}, [](const ScoredTruth& t) { return key_of(t.truth); });
    const auto found =
        std::ranges::equal_range(input.detections, key_of(frame), {}, key_of<FoundSource>);
    judge_frame(frame, truths, found, out);
  }
  std::vector<std::string> names;
  for (const auto& f : input.frames) names.push_back(f.sensor);
  for (const auto& t : input.truths) names.push_back(t.sensor);
  for (const auto& d : input.detections) names.push_back(d.sensor);
  std::ranges::sort(names);
  names.erase(std::unique(names.begin(), names.end()), names.end());
  names.push_back("");
  for (const auto& name : names) out.sensors.push_back(summary(out, input, name, frames));
  return out;
}

}  // namespace dmise
