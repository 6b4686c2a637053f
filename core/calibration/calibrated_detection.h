#pragma once
#include <functional>
#include <memory>
#include <optional>

#include "core/calibration/solve_frame.h"
#include "core/detection/detect.h"

namespace dmise {

/// A detector with a catalogue of stars, which finds where a frame points if its header is wrong.
class CalibratedDetector {
 public:
  /// Without a map it detects by the header alone.
  explicit CalibratedDetector(std::shared_ptr<const StarMap> map);

  struct Result {
    DetectionResult detection;
    FrameHeader header;                     // by which it detected
    std::optional<FrameSolution> solution;  // if the header's pointing was wrong
  };

  /// Told of the header of a solved frame whose pointing was not known, before detection by it: who
  /// knows more may complete it.
  std::function<void(const CountImage&, FrameHeader&)> after_solution;

  /// Detects by the header if the frame's stars are where it says, and by the plate that its stars
  /// show if they are elsewhere, or the header does not know their light, and there is a solution
  /// near the header's pointing. A `blind` one believes no pointing, and throws `Error` if there is
  /// no solution.
  Result detect(const Frame& frame, const DetectorSettings& settings, Threads& threads,
                bool blind = false) const;

 private:
  std::shared_ptr<const StarMap> map_;
  std::optional<CatalogueSky> sky_;
};

}  // namespace dmise
