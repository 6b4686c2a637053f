#pragma once
#include <cstddef>
#include <vector>

#include "core/report/run_contents.h"

namespace dmise {

struct ReportSettings {
  std::size_t max_views = 200;              // frames that can be opened with their pixels
  double max_megapixels = 500.0;            // in FITS files that are read for them
  std::size_t max_pixel_bytes = 6'000'000;  // for these pixels in the page
  std::size_t max_frames = 6000;            // drawn in curves
  std::size_t max_sources = 12000;          // truths in the page, and as many detections
};

/// Which frames the page draws, and which of them can be opened with their pixels.
struct DrawnFrames {
  std::size_t every = 1;            // one of so many of a sensor's frames is drawn
  std::vector<std::size_t> row_of;  // by frame of the run, if it is in the page
  std::vector<std::size_t> frames;  // index in the run, by row
  std::vector<std::size_t> viewed;  // rows
  std::vector<bool> with_sources;   // by frame: its truth and detections are in the page
  std::size_t source_every = 1;     // one of so many of them has its sources in the page
};

DrawnFrames choose_frames(const RunContents& run, const ReportSettings& settings);

}  // namespace dmise
