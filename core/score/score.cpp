#include "core/score/score.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>
#include <tuple>
#include <utility>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/frames/vec.h"
#include "core/score/association.h"
#include "core/score/matched_filter.h"
#include "core/score/sensor_tally.h"
#include "core/score/trail.h"

namespace dmise {
namespace {

/// d' C^-1 d / 2; empty if the covariance is not positive definite.
std::optional<double> half_nees(double x, double y, const std::array<double, 3>& c) {
  const double determinant = c[0] * c[2] - c[1] * c[1];
  if (!(c[0] > 0.0 && determinant > 0.0)) return {};
  return 0.5 * (x * x * c[2] - 2.0 * x * y * c[1] + y * y * c[0]) / determinant;
}

void add_direction(MatchErrors& e, const ScoredTruth& t, const Detection& d) {
  if (!t.truth.ra_rad || !t.truth.dec_rad) return;
  const auto at = from_spherical<Gcrs>(*t.truth.ra_rad, *t.truth.dec_rad);
  const auto seen = from_spherical<Gcrs>(d.corrected_ra_rad, d.corrected_dec_rad);
  // The covariance is in the directions of east and north at the detection.
  const double ra = d.corrected_ra_rad, dec = d.corrected_dec_rad;
  const Vec<Gcrs> east{-std::sin(ra), std::cos(ra), 0.0};
  const Vec<Gcrs> north{-std::cos(ra) * std::sin(dec), -std::sin(ra) * std::sin(dec),
                        std::cos(dec)};
  const double x = dot(seen - at, east), y = dot(seen - at, north);
  e.nees_sky = half_nees(x, y, d.covariance_rad2);
  if (t.is_point()) {
    e.along_arcsec = x / arcsec;
    e.across_arcsec = y / arcsec;
  } else if (d.kind == DetectionKind::streak) {
    const double s = std::sin(d.position_angle_rad), c = std::cos(d.position_angle_rad);
    e.along_arcsec = (x * s + y * c) / arcsec;
    e.across_arcsec = (y * s - x * c) / arcsec;
  }
}

void add_ends(MatchErrors& e, const ScoredTruth& t, const Detection& d, const TrueTrail& trail) {
  if (t.is_point() || !t.truth.whole || d.kind != DetectionKind::streak) return;
  auto first = trail.nearest({d.end1_x_px, d.end1_y_px});
  auto second = trail.nearest({d.end2_x_px, d.end2_y_px});
  SimTime first_time = d.end1_time, second_time = d.end2_time;
  if (first.along_px > second.along_px) {
    std::swap(first, second);
    // The times belong to the ends only if the direction is known.
    if (d.direction_known) std::swap(first_time, second_time);
  }
  e.start_along_px = -first.along_px;
  e.start_across_px = first.across_px;
  e.end_along_px = second.along_px - trail.length_px();
  e.end_across_px = second.across_px;
  if (!t.truth.start_time || !t.truth.end_time) return;
  const double exposure_s = (*t.truth.end_time - *t.truth.start_time).seconds();
  e.start_time_s = (first_time - *t.truth.start_time).seconds() - first.u * exposure_s;
  e.end_time_s = (second_time - *t.truth.start_time).seconds() - second.u * exposure_s;
}

/// Whether a band is V by its name, as "bessell-V": truth has magnitudes of no other.
bool is_visual(std::string_view band) {
  return band == "V" || band.ends_with("-V") || band.ends_with(" V") || band.ends_with("_V");
}

/// Errors of the detection of a truth with light; each is empty where either side does not know
/// the quantity.
MatchErrors errors_of(const ScoredTruth& t, const Detection& d, const ScoredFrame& frame) {
  MatchErrors e;
  const TrueTrail trail(t.truth.start, t.truth.middle, t.truth.end);
  const PixelPosition off = PixelPosition{d.x_px, d.y_px} - *t.truth.light;
  const PixelPosition along =
      t.is_point() ? PixelPosition{1.0, 0.0} : trail.direction(trail.nearest(*t.truth.light).u);
  e.along_px = off.x_px * along.x_px + off.y_px * along.y_px;
  e.across_px = off.y_px * along.x_px - off.x_px * along.y_px;
  e.nees_px = half_nees(off.x_px, off.y_px, d.covariance_px2);
  if (t.truth.signal_e && frame.noise_e && frame.sigma_px)
    e.over_bound = *e.across_px / position_bound_px({*t.truth.signal_e, t.length_px, *frame.noise_e,
                                                     *frame.sigma_px});
  add_direction(e, t, d);
  if (t.truth.magnitude && (is_visual(d.band) || !t.truth.start_time)) {
    e.magnitude = d.magnitude - frame.solar_colour_mag - *t.truth.magnitude;
    if (d.magnitude_sigma > 0.0) e.magnitude_over_sigma = *e.magnitude / d.magnitude_sigma;
  }
  if (t.truth.signal_e && d.signal_e > 0.0) {
    e.flux = -2.5 * std::log10(d.signal_e / *t.truth.signal_e);
    if (d.magnitude_sigma > 0.0) e.flux_over_sigma = *e.flux / d.magnitude_sigma;
  }
  add_ends(e, t, d, trail);
  return e;
}

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
