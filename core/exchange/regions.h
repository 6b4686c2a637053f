#pragma once
#include <vector>

#include "core/exchange/export_format.h"

namespace dmise {

/// DS9 region files of each frame with truth or detections: SENSOR/frame-000001-KIND.image.reg in
/// pixels, (1, 1) the centre of the first, and .icrs.reg in degrees by the frame's WCS. Points are
/// circles, trails lines.
std::vector<ExportedFile> region_files(const ExportRequest& request);

}  // namespace dmise
