#pragma once
#include <string>
#include <vector>

#include "core/base/parallel.h"
#include "core/detection/detect.h"
#include "core/image/fits_file.h"

namespace dmise {

/// Detections in a FITS frame, and as JSON lines: the same bytes as when the frame was made,
/// because detection uses `as_in_file(header)` there. The report is the frame's, without what only
/// a renderer knows.
struct FileDetections {
  std::vector<std::string> lines;  // one per detection, by falling SNR
  std::string report;
  DetectionResult result;
};

/// As lines: what was detected in a frame by a header.
FileDetections as_lines(DetectionResult result, const FrameHeader& header, const FrameNotes& notes);

/// `settings` without the pixels of a frame that have no value.
DetectorSettings settings_for(const Frame& frame, const DetectorSettings& settings);

FileDetections detect_frame(const Frame& frame, const DetectorSettings& settings, Threads& threads,
                            const CatalogueSky* sky = nullptr);

/// Throws `ConfigError` "PATH: KEYWORD: reason" if the file is not such a frame.
FileDetections detect_file(const std::string& path, const DetectorSettings& settings,
                           Threads& threads, const CatalogueSky* sky = nullptr);

/// UTC text of a time in the frame: the header's own for start, middle and end of the exposure
/// (with a Z, which FITS omits) and, with a rolling shutter, whole microseconds later; empty where
/// the header does not say it. Throws `Error` for other times.
std::string utc_in_frame(const FrameHeader& header, SimTime time);

}  // namespace dmise
