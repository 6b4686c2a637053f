#pragma once
#include <optional>

#include "core/camera_calibration/detector/bias_frames.h"
#include "core/camera_calibration/detector/camera_calibration.h"
#include "core/camera_calibration/detector/dark_frames.h"
#include "core/camera_calibration/detector/flat_response.h"
#include "core/camera_calibration/detector/photon_transfer.h"

namespace dmise {

/// What a set's frames of bias, dark and flat show of a detector.
struct DetectorCalibration {
  std::optional<BiasMeasurement> bias;
  std::optional<DarkMeasurement> dark;
  Saturation saturation;
  Linearity linearity;
  PhotonTransfer transfer;
  FlatResponse response;
  std::vector<std::string> notes;

  /// The coupling of neighbours, {0, 0} where it is hidden in its deviation.
  MeasuredValue coupling() const;
};

DetectorCalibration calibrate_detector(const CalibrationSet& set, Threads& threads);

/// Adds them to a camera file, in electrons.
void add_detector(const CalibrationSet& set, const DetectorCalibration& detector,
                  std::optional<double> quantum_efficiency, CameraCalibration& camera);

}  // namespace dmise
