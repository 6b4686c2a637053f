#pragma once
#include <optional>
#include <vector>

#include "core/camera_calibration/detector/bias_frames.h"

namespace dmise {

/// What frames without light show over time [DN/s].
struct DarkMeasurement {
  int frames = 0;
  double longest_s = 0.0;
  MeasuredValue current;                // in ordinary pixels
  MeasuredValue hot_fraction;           // share of pixels with more, exponentially distributed
  MeasuredValue hot_rate;               // mean of what they have more
  double threshold = 0.0;               // excess from which a pixel is counted as hot
  std::size_t counted = 0;              // pixels beyond it
  std::size_t clipped = 0;              // those beyond what the longest frame can hold
  std::optional<double> temperature_c;  // mean
  double temperature_spread_c = 0.0;    // largest difference
  double drift = 0.0;        // rms of the frames' rates about the mean, where significant
  std::vector<float> rates;  // one for each pixel: its own if it is hot
};

/// Measures darks that are longer than the bias's exposure. `saturation_dn`: above the bias; 0 if
/// it is not known. `coupling`: the share of a pixel's charge that each neighbour sees.
DarkMeasurement measure_dark(const CalibrationSet& set, const std::vector<CalibrationFrame>& frames,
                             const BiasMeasurement& bias, double saturation_dn, double coupling);

}  // namespace dmise
