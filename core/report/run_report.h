#pragma once
#include <string>

#include "core/base/parallel.h"
#include "core/report/run_contents.h"
#include "core/sky/star_map.h"

namespace dmise {

struct ReportSettings {
  std::size_t most_views = 200;              // frames that can be opened with their pixels
  double most_megapixels = 500.0;            // of FITS files that are read for them
  std::size_t most_pixel_bytes = 6'000'000;  // of these pixels in the page
  std::size_t most_frames = 6000;            // of which curves are drawn
  std::size_t most_sources = 12000;          // of truth, likewise of detections
};

/// A page of a run, without a server and without a network: its summary, pictures, curves, tables
/// and links to its files. `stars`: catalogue whose stars are marked; null: none are. Its bytes
/// depend on the directory's files alone. Names of sensors and objects are data in it, never markup
/// or script; what its script may do is limited by a Content-Security-Policy.
std::string run_report(const RunContents& run, const StarMap* stars, Threads& threads,
                       const ReportSettings& settings = {});

}  // namespace dmise
