#pragma once
#include <vector>

#include "core/base/image.h"
#include "core/base/parallel.h"
#include "core/detection/catalogue_sky.h"
#include "core/detection/stars_seen.h"
#include "core/products/detection.h"
#include "core/products/frame_header.h"
#include "core/products/pixel_mask.h"

namespace dmise {

/// Parameters of detection. SNRs are in units of the matched filter's noise.
struct DetectorSettings {
  int background_cell_px = 64;
  double seed_snr = 5.0;             // minimum peak of a source in the filtered frame
  double connect_snr = 3.0;          // threshold of its pixels
  double least_snr = 6.0;            // minimum SNR of the fitted flux
  double least_light_snr = 3.0;      // likewise where the flux has the errors of the ends
  double least_difference_px = 1.5;  // minimum difference between a source's and a star's trail
  double least_snr_in_stars = 10.0;  // of a streak against the scatter of stars beside it
  // Minimum SNR at which a streak's evenness is measurable: in total, and per px.
  double even_snr = 25.0, even_snr_per_px = 5.0;
  double blend_margin = 16.0;  // deviance by which a short streak must beat two blended stars
  double line_margin = 8.0;    // likewise for a short streak against a point that is no star
  double chain_margin = 6.0;   // likewise for a row of two to four stars, corrected for chance
  double model_error = 0.03;   // relative error of the PSF in comparisons of shape
  // The same for the wings of a saturated source: per square of the sigma at which they begin, with
  // minimum and maximum.
  double wings_error = 0.02, least_wings_error = 0.1, most_wings_error = 0.5;
  // Where the background's level is missed by more than this in units of a pixel's noise, streaks
  // without a single bright pixel are not searched for.
  double most_bend_in_noise = 0.15;
  // Pixels without a value, which are not used; null: all have one.
  const PixelMask* unusable = nullptr;
};

struct DetectionResult {
  FrameReport report;                 // without what only a renderer knows (`*_rendered`, `plan`)
  std::vector<Detection> detections;  // not star-like, by falling SNR
  StarsSeen stars;                    // nothing without a catalogue
};

/// Detects what is no star, from the counts and the header alone. With a catalogue of stars, its
/// stars are hidden, and a source that is bright enough for it and not in it is no star, whatever
/// its shape. Without one, or if the frame does not show its stars where they should be, sources
/// are detected that do not move like the stars. Equal for any number of threads. Detects nothing
/// if the header says that the shutter was closed. Needs memory for two images of 16 bits, a few
/// rows and the sources, besides the frame.
DetectionResult detect(const CountImage& counts, const FrameHeader& header,
                       const DetectorSettings& settings, Threads& threads,
                       const CatalogueSky* sky = nullptr);

/// The report of a frame without detection: header data, and `detection_off`.
DetectionResult without_detection(const CountImage& counts, const FrameHeader& header);

}  // namespace dmise
