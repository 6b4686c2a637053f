#include "core/sequences/detect_sequence.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/formatted.h"
#include "core/base/units.h"
#include "core/sequences/describe_track.h"
#include "core/sequences/tracklets.h"

namespace dmise {
namespace {

constexpr double max_trial_rates = 4000;       // in the range by default
constexpr double max_asked_trial_rates = 1e6;  // in a range that was asked for
constexpr double candidate_margin = 1.0;       // SNR that a sum at whole pixels may lack
constexpr double min_share_of_steady = 0.62;   // SNR without the best frames, over the threshold
constexpr std::size_t min_frames_for_two = 8, min_frames_for_one = 5;
constexpr double min_share_of_each = 0.3;  // each of a few frames has this share of the mean light
constexpr double hidden_widths = 2.0;      // FWHM around what was found

MotionRange range_of(const FilteredSequence& sequence, const Registration& registration,
                     const std::vector<SequenceFrame>& frames, const SequenceSearch& search) {
  const FrameHeader& header = frames[sequence.reference].header;
  const bool pointed = !header.unknown.has(FrameFact::pointing);
  const double scale_rad_per_px =
      pointed ? wcs_scale_rad_per_px(header.wcs) : 1 / header.focal_length_px;
  double max_px_per_s = 0.0;
  if (search.max_rate_rad_per_s) {
    if (!pointed) throw ConfigError("--max-rate: takes frames with a WCS, or solved ones");
    max_px_per_s = *search.max_rate_rad_per_s / scale_rad_per_px;
  }
  MotionRange range = motion_range(sequence, registration, scale_rad_per_px, max_px_per_s);
  const double count = count_of_trial_rates(sequence, range);
  if (search.max_rate_rad_per_s && search.stack && count > max_asked_trial_rates)
    throw ConfigError(formatted("--max-rate: is %.0f rates to try, more than %.0f", count,
                                max_asked_trial_rates));
  return range;
}

/// The range whose rates the stack tries: by default half of that of tracklets, as of points that
/// trail by one width of the PSF, and no more than `max_trial_rates`.
MotionRange stacked_range(const TrackScene& scene, const SequenceSearch& search,
                          std::vector<std::string>& notes) {
  MotionRange range = scene.range;
  if (search.max_rate_rad_per_s) return range;
  range.max_px_per_s /= 2;
  const double count = count_of_trial_rates(scene.sequence, range);
  if (count <= max_trial_rates) return range;
  range.max_px_per_s *= std::sqrt(max_trial_rates / count);
  notes.push_back(formatted(
      "sequence: what single frames do not show is searched up to %.2f px "
      "a frame; --max-rate asks for more",
      range.max_px_per_s * scene.sequence.span_s() / double(scene.sequence.frames.size() - 1)));
  return range;
}

/// Whether the light of a track is that of one object, rather than of a few bright pixels.
bool is_steady(const MovingTrack& track, double threshold) {
  const std::size_t n = track.points.size();
  const std::size_t left_out = n >= min_frames_for_two ? 2 : n >= min_frames_for_one ? 1 : 0;
  if (steady_snr(track, 0) < threshold) return false;
  if (left_out > 0) return steady_snr(track, left_out) >= min_share_of_steady * threshold;
  return std::ranges::all_of(
      track.points, [](const TrackPoint& p) { return p.snr > min_share_of_each * p.expected; });
}

/// Takes the light of a track out of the frames.
void hide(const MovingTrack& track, const TrackScene& scene) {
  const PixelPosition over_detector = track.motion.rate - scene.range.middle;
  const double trail_px =
      std::hypot(over_detector.x_px, over_detector.y_px) * scene.sequence.exposure_s;
  for (std::size_t i = 0; i < scene.light.size(); ++i) {
    MovingLight& light = scene.light[i];
    const PixelPosition at =
        scene.registration.in_frame(i, track.motion.at(scene.sequence.frames[i].time_s));
    if (!(std::hypot(at.x_px, at.y_px) < max_away_px)) continue;
    const double bright = std::max(snr_at(light, at).snr / 10, 1.0);
    const double reach =
        hidden_widths * fwhm_per_sigma * scene.sequence.sigma_px * (1 + 0.3 * std::log10(bright)) +
        trail_px / 2;
    const auto clamp = [](double px, int count) { return int(std::clamp(px, 0.0, double(count))); };
    for (int y = clamp(at.y_px - reach, light.snr.rows);
         y < clamp(at.y_px + reach + 1, light.snr.rows); ++y)
      for (int x = clamp(at.x_px - reach, light.snr.columns);
           x < clamp(at.x_px + reach + 1, light.snr.columns); ++x)
        if (std::hypot(x - at.x_px, y - at.y_px) <= reach) light.weight.at(x, y) = 0;
  }
}

/// Accepts the motions that are objects, and takes their light out.
void accept(const std::vector<SkyMotion>& motions, const TrackScene& scene, double threshold,
            const std::function<void(const MovingTrack&)>& take) {
  for (const SkyMotion& motion : motions) {
    const auto track = fit_track(scene, motion);
    if (!track || track->snr < threshold || !scene.range.has(track->motion.rate)) continue;
    if (!is_steady(*track, threshold)) continue;
    take(*track);
    hide(*track, scene);
  }
}

}  // namespace

SequenceResult detect_sequence(std::vector<SequenceFrame> frames, const SequenceSearch& search,
                               Threads& threads) {
  check_sequence(frames);
  sort_by_time(frames);
  FilteredSequence sequence = filter_sequence(frames, threads);
  const Registration registration(frames, sequence);
  SequenceResult result{.tracks = {}, .notes = registration.notes()};
  const MotionRange range = range_of(sequence, registration, frames, search);
  auto light = moving_light(sequence, registration, threads);
  for (FilteredLight& frame : sequence.frames) {
    frame.light = {};
    frame.known = {};
  }
  const TrackScene scene{sequence, registration, range, light};
  const MotionRange stacked = stacked_range(scene, search, result.notes);
  const double threshold = stack_threshold(sequence, stacked);
  bool by_stack = false;
  const auto take = [&](const MovingTrack& track) {
    result.tracks.push_back(describe_track(track, scene, frames));
    result.tracks.back().by_stack = by_stack;
  };
  accept(link_points(scene), scene, threshold, take);
  if (search.stack) {
    by_stack = true;
    const TrackScene narrower{sequence, registration, stacked, light};
    accept(stack_motions(narrower, threshold - candidate_margin, threads, search.progress),
           narrower, threshold, take);
  }
  std::stable_sort(result.tracks.begin(), result.tracks.end(),
                   [](const SequenceTrack& a, const SequenceTrack& b) {
                     return a.detection.snr > b.detection.snr;
                   });
  for (std::size_t i = 0; i < result.tracks.size(); ++i)
    number_track(result.tracks[i], std::uint32_t(i));
  return result;
}

}  // namespace dmise
