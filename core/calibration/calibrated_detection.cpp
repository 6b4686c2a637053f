#include "core/calibration/calibrated_detection.h"

#include <cmath>

#include "core/base/error.h"

namespace dmise {
namespace {

constexpr double most_shift_px = 0.2;  // of the stars from where the header has them
constexpr int least_stars = 8;         // that must be expected before the header is doubted

bool is_wrong(const StarsSeen& stars) {
  if (stars.expected < least_stars) return false;
  return !stars.known || std::hypot(stars.shift.x_px, stars.shift.y_px) > most_shift_px;
}

}  // namespace

CalibratedDetector::CalibratedDetector(std::shared_ptr<const StarMap> map) : map_(std::move(map)) {
  if (map_) sky_.emplace(map_);
}

CalibratedDetector::Result CalibratedDetector::detect(const Frame& frame,
                                                      const DetectorSettings& settings,
                                                      Threads& threads, bool blind) const {
  const CatalogueSky* sky = sky_ ? &*sky_ : nullptr;
  Result result{.detection = {}, .header = frame.header, .solution = std::nullopt};
  if (!blind) {
    result.detection = dmise::detect(frame.counts, frame.header, settings, threads, sky);
    if (!is_wrong(result.detection.stars)) return result;
  }
  if (!map_) throw Error("blind detection takes a catalogue of stars");
  try {
    result.solution = solve_frame(frame, *map_, {.blind = blind, .search = {}}, threads);
  } catch (const Error&) {
    if (blind) throw;
    return result;  // clouds, or what is there are no stars of the catalogue
  }
  result.header = solved_header(frame.header, *result.solution);
  result.detection = dmise::detect(frame.counts, result.header, settings, threads, sky);
  return result;
}

}  // namespace dmise
