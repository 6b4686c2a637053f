#pragma once
#include <vector>

#include "core/base/image.h"
#include "core/base/parallel.h"
#include "core/products/detection.h"
#include "core/products/frame_header.h"

namespace dmise {

/// Knobs of the detector. SNRs are in units of the matched filter's own noise.
struct DetectorSettings {
  int background_cell_px = 64;
  double seed_snr = 5.0;             // a source must reach this in one pixel of the filtered frame
  double connect_snr = 3.0;          // pixels above this belong to it
  double least_snr = 6.0;            // of the fitted flux of what is published
  double least_difference_px = 1.5;  // between a source's trail and a star's there
  double least_snr_in_stars = 10.0;  // of a streak against the scatter of the stars beside it
  // From here on a streak is seen to be even, as no row of stars is: in all, and each px of it.
  double even_snr = 25.0, even_snr_per_px = 5.0;
  double blend_margin = 16.0;  // deviance by which a short streak must beat two blended stars
  double chain_margin = 6.0;   // by which it must beat a row of two to four, chance allowed for
  double model_error = 0.03;   // relative, of the PSF, when shapes are judged
  // The same where a saturated source has its wings alone: for each square of the sigma at which
  // they begin, at least and at most so much.
  double wings_error = 0.02, least_wings_error = 0.1, most_wings_error = 0.5;
};

struct DetectionResult {
  FrameReport report;  // complete but for what only a renderer knows (`*_rendered`, `plan`)
  std::vector<Detection> detections;  // published: not star-like, by falling SNR
};

/// Finds what does not move as the stars do, from the counts and the header alone. Equal for any
/// number of threads. Memory beside the frame: a few rows and the sources.
DetectionResult detect(const CountImage& counts, const FrameHeader& header,
                       const DetectorSettings& settings, Threads& threads);

/// The report of a frame in which nothing is looked for: what the header says, and that detection
/// is off.
DetectionResult without_detection(const CountImage& counts, const FrameHeader& header);

}  // namespace dmise
