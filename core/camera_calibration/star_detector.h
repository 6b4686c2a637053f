#pragma once
#include "core/base/numeric/monotone_cubic.h"
#include "core/camera_calibration/detector/detector_calibration.h"
#include "core/camera_calibration/gaussian_stars.h"
#include "core/ingest/any_frame.h"

namespace dmise {

/// What a detector does to the light of stars, taken off frame by frame. Holds what it is made of.
class StarDetector {
 public:
  StarDetector(const CalibrationSet& set, const DetectorCalibration& detector);

  /// The header by what bias and flats have shown, in counts as they are in memory.
  void set_facts(Frame& frame) const;
  StarPixels pixels(const CalibrationFrame& from, const Frame& frame) const;
  /// Light of the lens at a pixel, relative to the brightest.
  double illumination(PixelPosition at) const;

 private:
  StarPixels corrected(const CalibrationFrame& from, const Frame& frame) const;

  const CalibrationSet& set_;
  const DetectorCalibration& d_;
  MonotoneCubic illumination_;
};

}  // namespace dmise
