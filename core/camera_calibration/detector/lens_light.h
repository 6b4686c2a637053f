#pragma once
#include <vector>

#include "core/camera_calibration/detector/calibration_set.h"
#include "core/camera_calibration/detector/jackknife.h"

namespace dmise {

/// Light at a distance from the middle of the frame, relative to the brightest.
struct FieldLight {
  double radius_px = 0.0;
  MeasuredValue relative;
};

/// Light over the field by two halves of the flats, as means of tiles: a polynomial in the squared
/// radius. By rising radius; empty if the frame does not determine it.
std::vector<FieldLight> measure_lens_light(const CalibrationSet& set,
                                           const std::vector<float>& first,
                                           const std::vector<float>& second);

}  // namespace dmise
