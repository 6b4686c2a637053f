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
#include "core/score/sensor_tally.h"
#include "core/score/trail.h"

namespace dmise {
namespace {

using FrameKey = std::tuple<std::string, std::size_t, std::string>;  // "9" before "10"

template <class Record>
FrameKey key_of(const Record& r) {
  return {r.sensor, r.frame.size(), r.frame};
}

FrameKey key_of(const ScoredTruth& t) { return key_of(t.truth); }

/// The records of a frame in a list that is sorted by frames.
template <class Record>
std::span<Record> of_frame(std::vector<Record>& list, const ScoredFrame& frame) {
  const auto begin = std::partition_point(
      list.begin(), list.end(), [&](const Record& r) { return key_of(r) < key_of(frame); });
  const auto end = std::partition_point(
      begin, list.end(), [&](const Record& r) { return key_of(r) == key_of(frame); });
  return {begin, end};
}

std::optional<double> if_finite(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? value : std::nullopt;
}

ScoredTruth known(const TrueSource& truth, const ScoredFrame* frame) {
  ScoredTruth t{.truth = truth};
  if (!frame || !frame->searched) return t;
  const TrueTrail trail(truth.start, truth.middle, truth.end);
  t.length_px = trail.length_inside_px(frame->columns, frame->rows);
  const bool enters = t.length_px > 0.0 || is_inside(truth.middle, frame->columns, frame->rows);
  t.fate = truth.light ? Fate::missed : enters ? Fate::dark : Fate::outside;
  if (frame->exposure_s > 0.0 && frame->scale_rad_per_px > 0.0)
    t.rate_arcsec_per_s = trail.length_px() * frame->scale_rad_per_px / arcsec / frame->exposure_s;
  if (truth.light && truth.signal_e && frame->noise_e && frame->sigma_px)
    t.snr = if_finite(
        matched_filter_snr({*truth.signal_e, t.length_px, *frame->noise_e, *frame->sigma_px}));
  return t;
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
      for (const ErrorKey& error : error_keys)
        t.errors.*error.value = if_finite(t.errors.*error.value);
    } else if (t.fate == Fate::missed && !t.is_above(score.settings.threshold_snr)) {
      t.fate = Fate::faint;
    }
  }
  for (const std::size_t k : pairs.false_alarms) score.false_alarms.push_back(detections[k]);
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
    judge_frame(frame, of_frame(out.truths, frame), of_frame(input.detections, frame), out);
  }
  SensorTally total("", settings);
  std::map<std::string, SensorTally> sensors;
  const auto add = [&](const std::string& sensor, const auto&... what) {
    total.add(what...);
    sensors.try_emplace(sensor, sensor, settings).first->second.add(what...);
  };
  for (const ScoredFrame& f : input.frames) add(f.sensor, f);
  for (const ScoredTruth& t : out.truths) add(t.truth.sensor, t);
  for (const FoundSource& d : input.detections) {
    const ScoredFrame* frame = frame_of(d);
    add(d.sensor, d, frame && frame->searched);
  }
  for (auto& [name, tally] : sensors) out.sensors.push_back(tally.finish());
  out.sensors.push_back(total.finish());
  return out;
}

}  // namespace dmise
