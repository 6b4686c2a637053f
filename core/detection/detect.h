#pragma once
#include <optional>
#include <vector>

#include "core/base/image.h"
#include "core/base/parallel.h"
#include "core/detection/known/catalogue_sky.h"
#include "core/detection/known/stars_seen.h"
#include "core/detection/stars/alike_trail.h"
#include "core/products/detection.h"
#include "core/products/frame_header.h"
#include "core/products/frame_report.h"
#include "core/products/pixel_mask.h"

namespace dmise {

struct DetectionResult {
  FrameReport report;                 // without what only a renderer knows (`*_rendered`, `plan`)
  std::vector<Detection> detections;  // not star-like, by falling SNR
  StarsSeen stars;                    // nothing without a catalogue
  // Streaks by which it was found that the mount does not follow the stars; empty: the header is
  // right.
  std::optional<AlikeStreaks> star_trails;
};

/// What is measured of detections beyond what always is.
struct DetectSettings {
  bool light_curves = false;  // measures how the light of streaks varies
};

/// Detects what is no star, from the counts and the header alone. With a catalogue of stars, its
/// stars are hidden, and a source that is bright enough for it and not in it is no star, whatever
/// its shape. Without one, or if the frame does not show its stars where they should be, sources
/// are detected that do not move like the stars. If the mount is unknown and streaks are alike as
/// trails of stars are, they are stars, unless there are more points than such streaks. Equal for
/// any number of threads. Detects nothing if the header says that the shutter was closed. Needs
/// memory for two images of 16 bits, a few rows and the sources, besides the frame. `unusable`:
/// pixels without a value; null: all have one.
DetectionResult detect(const CountImage& counts, const FrameHeader& header,
                       const PixelMask* unusable, Threads& threads,
                       const CatalogueSky* sky = nullptr, const DetectSettings& settings = {});

/// The report of a frame without detection: header data, and `detection_off`.
DetectionResult without_detection(const CountImage& counts, const FrameHeader& header);

}  // namespace dmise
