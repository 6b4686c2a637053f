#include "core/detection/described_sources.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <tuple>

#include "core/detection/describe.h"
#include "core/detection/make_report.h"
#include "core/detection/pixels/background.h"
#include "core/detection/pixels/detection_limits.h"
#include "core/wcs/wcs.h"

namespace dmise {
namespace {

std::vector<PixelPosition> places_of(const MeasuredSource& source) {
  if (!source.ends) return {source.centroid.place};
  return {source.centroid.place, source.ends->at(0).place, source.ends->at(1).place};
}

bool sees_sky(const MeasuredSource& source, const Wcs& wcs) {
  return std::ranges::all_of(places_of(source),
                             [&](PixelPosition at) { return wcs_sees_sky(wcs, at); });
}

/// Whether a pixel at the centroid, or on the line between the ends, is clipped.
bool has_clipped_pixel(const MeasuredSource& source, const CountImage& counts,
                       double lowest_clipped_dn) {
  const PixelPosition from = source.ends ? source.ends->at(0).place : source.centroid.place;
  const PixelPosition way = source.ends ? source.ends->at(1).place - from : PixelPosition{};
  const int steps = 1 + int(2 * std::hypot(way.x_px, way.y_px));
  for (int i = 0; i <= steps; ++i) {
    const PixelPosition at = from + way * (double(i) / steps);
    const long x = std::lround(at.x_px), y = std::lround(at.y_px);
    if (x < 0 || y < 0 || x >= counts.columns || y >= counts.rows) continue;
    if (counts.at(int(x), int(y)) >= lowest_clipped_dn) return true;
  }
  return false;
}

bool is_at_edge(const MeasuredSource& source, const CountImage& counts, double width_px) {
  return std::ranges::any_of(places_of(source), [&](PixelPosition at) {
    return std::min({at.x_px, at.y_px, counts.columns - 1 - at.x_px, counts.rows - 1 - at.y_px}) <
           width_px;
  });
}

/// Adds the detections that are made of sources, by falling SNR.
void describe_all(std::vector<MeasuredSource>& sources, const CountImage& counts,
                  const FrameHeader& header, std::vector<Detection>& detections) {
  std::stable_sort(sources.begin(), sources.end(),
                   [](const MeasuredSource& a, const MeasuredSource& b) {
                     const PixelPosition &p = a.centroid.place, &q = b.centroid.place;
                     return std::tuple(-a.snr, p.y_px, p.x_px) < std::tuple(-b.snr, q.y_px, q.x_px);
                   });
  for (const MeasuredSource& source : sources)
    if (sees_sky(source, header.wcs))
      add_detection(
          describe(source, header, has_clipped_pixel(source, counts, lowest_clipped_dn(header)),
                   is_at_edge(source, counts, header.psf_fwhm_px)),
          header, detections);
}

}  // namespace

DetectionResult described(FoundInFrame found, const CountImage& counts, const FrameHeader& header,
                          Threads& threads) {
  DetectionResult result;
  const Background background(counts, detection_limits::background_cell_px, threads);
  result.report = make_report(counts, header, background, PsfField::gaussian(header.psf_fwhm_px));
  if (auto* detections = std::get_if<std::vector<Detection>>(&found))
    result.detections = std::move(*detections);
  else
    describe_all(std::get<std::vector<MeasuredSource>>(found), counts, header, result.detections);
  result.report.detections = std::uint32_t(result.detections.size());
  return result;
}

}  // namespace dmise
