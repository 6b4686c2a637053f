#pragma once
#include <vector>

#include "core/image/picture.h"
#include "core/products/detection.h"
#include "core/products/frame_header.h"
#include "core/products/truth.h"

namespace dmise {

/// The preview in colour with truth (green) and detections (cyan streaks, yellow points) drawn in
/// and a strip of text below: sensor, time, exposure, legend, scale bar, where north and east are.
/// For eyes only: it shows truth, so it is never published.
Picture marked_picture(const Preview& preview, const FrameHeader& header,
                       const std::vector<Truth>& truths, const std::vector<Detection>& detections);

}  // namespace dmise
