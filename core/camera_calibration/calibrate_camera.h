#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/parallel.h"
#include "core/camera_calibration/detector/calibration_set.h"
#include "core/camera_calibration/detector/camera_calibration.h"
#include "core/sky/stars/star_map.h"

namespace dmise {

/// What the user knows of a camera beside its frames.
struct StatedCamera {
  std::string name, band;
  std::optional<double> pixel_pitch_m, focal_length_m, aperture_m, obscuration, transmission,
      quantum_efficiency;
};

/// Measures a camera by its own frames. What they do not tell is as the headers or the user say it,
/// else at a stated default, with a note. Without `stars` (null) lights are not solved. Throws
/// `ConfigError` for frames that are not of one camera.
CameraCalibration calibrate_camera(const std::vector<CalibrationFile>& files,
                                   const FrameChoice& choice, const StatedCamera& stated,
                                   const StarMap* stars, Threads& threads);

}  // namespace dmise
