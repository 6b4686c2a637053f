#pragma once
#include <string>
#include <vector>

#include "core/detection/detect.h"
#include "core/products/frame_notes.h"

namespace dmise {

/// What was detected in a frame as JSON lines: of a file the same bytes as when the frame was made,
/// because detection uses `as_in_file(header)` there.
struct DetectionLines {
  std::vector<std::string> lines;  // one per detection, by falling SNR
  std::string report;              // without what only a renderer knows
  DetectionResult result;
};

DetectionLines as_lines(DetectionResult result, const FrameHeader& header, const FrameNotes& notes);

/// UTC text of a time in the frame: the header's own for start, middle and end of the exposure
/// (with a Z, which FITS omits) and, with a rolling shutter, whole microseconds later; empty where
/// the header does not say it. Throws `Error` for other times.
std::string utc_in_frame(const FrameHeader& header, SimTime time);

}  // namespace dmise
