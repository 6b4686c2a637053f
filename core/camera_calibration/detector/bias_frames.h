#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/camera_calibration/detector/calibration_set.h"
#include "core/camera_calibration/detector/jackknife.h"

namespace dmise {

/// What frames without light and time show [DN].
struct BiasMeasurement {
  int frames = 0;
  double exposure_s = 0.0;    // the shortest darks have it, where these stand in
  std::vector<float> mean;    // one for each pixel; NaN where there is none
  MeasuredValue level;        // without electrons
  MeasuredValue read_noise;   // without rounding
  double floor_variance = 0;  // noise of a pixel in a frame, with rounding, without columns [DN2]
  MeasuredValue read_noise_spread;            // deviation of the logarithm of the pixels' rms
  MeasuredValue column_noise;                 // new in each frame
  MeasuredValue pixel_offset, column_offset;  // patterns that stay in each frame
  double drift_dn = 0.0;  // rms of the level from frame to frame, where it is significant
  bool clipped = false;   // the counts of many pixels are 0
};

/// Measures two frames or more of a camera's bias. `exposure_s` is that of darks that stand in.
BiasMeasurement measure_bias(const CalibrationSet& set, const std::vector<CalibrationFrame>& frames,
                             double exposure_s);

}  // namespace dmise
