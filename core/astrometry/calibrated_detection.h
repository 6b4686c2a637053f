#pragma once
#include <functional>
#include <memory>
#include <optional>

#include "core/astrometry/solve_frame.h"
#include "core/detection/detect.h"

namespace dmise {

/// Detection with a catalogue of stars, which solves a frame whose header's pointing is wrong.
class CalibratedDetector {
 public:
  /// Without a map it detects by the header alone.
  explicit CalibratedDetector(std::shared_ptr<const StarMap> map);

  struct Result {
    DetectionResult detection;
    FrameHeader header;                     // by which it detected
    std::optional<FrameSolution> solution;  // if the header's pointing was wrong
    FrameNotes notes;  // the frame's, of what is still missing, and why the catalogue is not used
  };

  /// Called with the counts and the header of a solved frame whose pointing was unknown, before
  /// detection; may complete the header.
  std::function<void(const CountImage&, FrameHeader&)> after_solution;

  DetectSettings settings;

  /// Detects by the header if the frame's stars are where it says. If they are elsewhere, or if the
  /// header lacks what expecting them needs, solves the frame near the header's pointing and
  /// detects by the solution, if there is one. If `blind`, solves it without the header's pointing,
  /// and throws `Error` if there is no solution. Pixels that the camera knows to be hot are not
  /// used.
  Result detect(const Frame& frame, Threads& threads, bool blind = false) const;

 private:
  Result detect_calibrated(const Frame& frame, Threads& threads, bool blind) const;

  std::shared_ptr<const StarMap> map_;
  std::optional<CatalogueSky> sky_;
};

}  // namespace dmise
