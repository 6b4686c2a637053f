#pragma once
#include <vector>

#include "core/image/charts/picture.h"
#include "core/products/detection.h"
#include "core/products/frame_header.h"
#include "core/products/truth.h"

namespace dmise {

/// The preview in colour with truth (green) and detections (cyan streaks, yellow points) drawn in
/// and a strip of text below: sensor, time, exposure, legend, scale bar, directions of north and
/// east. Never published, because it shows truth.
Picture marked_picture(const Preview& preview, const FrameHeader& header,
                       const std::vector<Truth>& truths, const std::vector<Detection>& detections);

}  // namespace dmise
