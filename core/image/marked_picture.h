#pragma once
#include <vector>

#include "core/detection/detection.h"
#include "core/detection/truth.h"
#include "core/image/frame_header.h"
#include "core/image/picture.h"

namespace dmise {

/// The preview in colour with truth (green) and detections (cyan streaks, yellow points) drawn in
/// and a strip of text below: sensor, time, exposure, legend, scale bar, where north and east are.
/// For eyes only: it shows truth, so it is never published.
Picture marked_picture(const Preview& preview, const FrameHeader& header,
                       const std::vector<Truth>& truths, const std::vector<Detection>& detections);

}  // namespace dmise
