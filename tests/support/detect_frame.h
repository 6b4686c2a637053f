#pragma once
#include "core/detection/detection_lines.h"
#include "core/image/fits_file.h"

namespace dmise::test {

/// What is detected in a frame by its header alone.
inline DetectionLines detect_frame(const Frame& frame, Threads& threads) {
  DetectorSettings settings;
  if (!frame.unusable.pixels.empty()) settings.unusable = &frame.unusable;
  return as_lines(detect(frame.counts, frame.header, settings, threads), frame.header, frame.notes);
}

}  // namespace dmise::test
