#pragma once
#include "core/detection/detection_lines.h"
#include "core/image/fits_file.h"

namespace dmise::test {

/// What is detected in a frame by its header alone.
inline DetectionLines detect_frame(const Frame& frame, Threads& threads) {
  const PixelMask* unusable = frame.unusable.pixels.empty() ? nullptr : &frame.unusable;
  return as_lines(detect(frame.counts, frame.header, unusable, threads), frame.header, frame.notes);
}

}  // namespace dmise::test
