#include "core/astrometry/calibrated_detection.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/base/formatted.h"
#include "core/base/units.h"
#include "core/image/known_defects.h"

namespace dmise {
namespace {

constexpr double max_shift_px = 0.2;  // from where the header has the stars to where they are
constexpr double max_shift_sigmas = 5.0;
constexpr int min_stars = 8;  // expected, and seen, before the header is doubted

/// Whether a frame's stars are not where its header says. False where there is nothing like stars,
/// as in clouds.
bool is_wrong(const DetectionResult& result) {
  const StarsSeen& stars = result.stars;
  if (stars.expected < min_stars) return false;
  if (!stars.agree()) return result.report.star_like >= std::uint32_t(min_stars);
  const double sigma_px = stars.scatter_px / std::sqrt(double(stars.found));
  return std::hypot(stars.shift.x_px, stars.shift.y_px) >
         std::max(max_shift_px, max_shift_sigmas * sigma_px);
}

/// Removes the notes of facts that a solution has found.
void remove_found(const UnknownFacts& unknown, FrameNotes& notes) {
  for (const auto& [fact, begin] : {std::pair{FrameFact::pointing, "pointing: "},
                                    {FrameFact::focal_length, "focal length: "},
                                    {FrameFact::zero_point, "zero point: "}})
    if (!unknown.has(fact))
      std::erase_if(notes.missing, [&, begin = begin](const std::string& text) {
        return text.starts_with(begin);
      });
}

/// Notes why the catalogue is not used, if so: what it would need, of which the last is found by a
/// solution, or that the frame does not show its stars.
void note_unused_catalogue(const UnknownFacts& unknown, const DetectionResult& detection,
                           FrameNotes& notes) {
  const std::string not_used = "stars: the catalogue is not used";
  const StarsSeen& stars = detection.stars;
  if (!CatalogueSky::can_expect(unknown)) {
    const char* lacks = unknown.has(FrameFact::time)       ? "a time"
                        : unknown.has(FrameFact::exposure) ? "an exposure time"
                        : unknown.has(FrameFact::pointing) ? "a pointing"
                                                           : "a zero point";
    notes.missing.push_back(not_used + " without " + lacks);
  } else if (!detection.report.detection_off && !stars.agree()) {
    notes.missing.push_back(not_used + (stars.expected == 0
                                            ? ": none of its stars is expected to be seen"
                                            : ": " + std::to_string(stars.found) + " of " +
                                                  std::to_string(stars.expected) +
                                                  " stars are where they are expected"));
  }
}

/// Notes that streaks are trails of stars, instead of what was assumed of the mount.
void note_trails(const DetectionResult& detection, FrameNotes& notes) {
  if (!detection.star_trails) return;
  const auto& [trail, count] = *detection.star_trails;
  std::erase_if(notes.assumed, [](const std::string& text) { return text.starts_with("mount: "); });
  notes.assumed.push_back(formatted(
      "mount: drifts evenly: %zu streaks are alike, as trails of stars are: %.3g px at "
      "%.1f deg to the rows",
      count, std::hypot(trail.x_px, trail.y_px), std::atan2(trail.y_px, trail.x_px) / deg));
}

/// Notes that there is no plate near a header's pointing.
void note_no_plate(const UnknownFacts& unknown, FrameNotes& notes) {
  const std::string where = unknown.has(FrameFact::pointing)
                                ? "near RA and DEC"
                                : "near the WCS, which they do not confirm";
  notes.missing.push_back("stars: no plate was found " + where +
                          "; --blind searches the whole sky");
}

}  // namespace

CalibratedDetector::CalibratedDetector(std::shared_ptr<const StarMap> map) : map_(std::move(map)) {
  if (map_) sky_.emplace(map_);
}

CalibratedDetector::Result CalibratedDetector::detect(const Frame& frame, Threads& threads,
                                                      bool blind) const {
  const auto calibrated = without_hot_pixels(frame);
  Result result = detect_calibrated(calibrated ? *calibrated : frame, threads, blind);
  note_trails(result.detection, result.notes);
  return result;
}

CalibratedDetector::Result CalibratedDetector::detect_calibrated(const Frame& frame,
                                                                 Threads& threads,
                                                                 bool blind) const {
  const PixelMask* unusable = frame.unusable.pixels.empty() ? nullptr : &frame.unusable;
  const UnknownFacts& unknown = frame.header.unknown;
  const auto detected_by = [&](const FrameHeader& header) {
    return dmise::detect(frame.counts, header, unusable, threads, sky_ ? &*sky_ : nullptr,
                         settings);
  };
  Result result{
      .detection = {}, .header = frame.header, .solution = std::nullopt, .notes = frame.notes};
  if (frame.header.shutter_closed()) blind = false;  // there are no stars
  if (!blind) {
    result.detection = detected_by(frame.header);
    const Observation& o = frame.header.observation;
    const bool has_hint = !unknown.has(FrameFact::pointing) || (o.ra_rad && o.dec_rad);
    const bool may_be_solved = map_ && has_hint && !unknown.has(FrameFact::time);
    if (!may_be_solved || (CatalogueSky::can_expect(unknown) && !is_wrong(result.detection))) {
      if (map_) note_unused_catalogue(unknown, result.detection, result.notes);
      return result;
    }
  }
  if (!map_) throw Error("blind detection needs a catalogue of stars");
  try {
    result.solution =
        solve_frame(frame, *map_, {.blind = blind, .elsewhere = blind, .search = {}}, threads);
  } catch (const Error&) {
    if (blind) throw;
    note_no_plate(unknown, result.notes);
    return result;  // clouds, or what is there are no stars of the catalogue
  }
  result.header = solved_header(frame.header, *result.solution);
  if (after_solution && unknown.has(FrameFact::pointing))
    after_solution(frame.counts, result.header);
  result.detection = detected_by(result.header);
  remove_found(result.header.unknown, result.notes);
  const auto& assumed = result.solution->notes.assumed;
  result.notes.assumed.insert(result.notes.assumed.end(), assumed.begin(), assumed.end());
  note_unused_catalogue(result.header.unknown, result.detection, result.notes);
  return result;
}

}  // namespace dmise
