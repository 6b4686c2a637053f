#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/base/parallel.h"
#include "core/camera_calibration/detector/detector_calibration.h"
#include "core/camera_calibration/lens_fit.h"
#include "core/camera_calibration/lens_width.h"
#include "core/sky/stars/star_map.h"

namespace dmise {

/// What frames of stars show of a lens.
struct StarMeasurement {
  int frames = 0;  // that were solved
  std::string projection = "gnomonic";
  std::optional<MeasuredValue> focal_length_px;
  std::optional<LensFit> lens;     // by the stars of all frames
  std::optional<LensWidth> width;  // before pixels and coupling
  int width_frames = 0;
  /// V of a source of the Sun's colour that gives 1 e-/s on the axis; with the air of the frame
  /// where its stars do not show the air.
  std::optional<MeasuredValue> zero_point_mag;
  bool with_air = false;
  std::vector<std::string> notes;  // also why a frame was not solved
};

/// Solves each frame of stars, without the marks of the detector that took it, and joins what they
/// show by their deviations, which are scaled where frames disagree.
StarMeasurement measure_stars(const CalibrationSet& set, const DetectorCalibration& detector,
                              const FrameChoice& choice, const StarMap& stars, Threads& threads);

}  // namespace dmise
