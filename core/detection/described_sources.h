#pragma once
#include <functional>
#include <optional>
#include <variant>
#include <vector>

#include "core/base/parallel.h"
#include "core/detection/detect.h"
#include "core/detection/measured_source.h"

namespace dmise {

/// Sources, such that `check_sources` accepts them, or detections as they were made of some before.
using FoundInFrame = std::variant<std::vector<MeasuredSource>, std::vector<Detection>>;

/// Finds what is in a frame in place of our detector; nothing: the run is being stopped.
using SourceFinder =
    std::function<std::optional<FoundInFrame>(const CountImage&, const FrameHeader&)>;

/// Detections of what another detector found in a frame, by falling SNR, and the report of the
/// frame: background and noise as `detect` measures them first, the PSF of the header, no stars.
/// Sources where the lens images no sky are left out. A pixel that is clipped at a centroid, or
/// between the ends of a streak, marks it as saturated; a place nearer to the frame's edge than the
/// width of the PSF as at the edge.
DetectionResult described(FoundInFrame found, const CountImage& counts, const FrameHeader& header,
                          Threads& threads);

}  // namespace dmise
