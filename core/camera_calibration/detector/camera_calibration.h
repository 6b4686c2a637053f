#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/camera_calibration/detector/jackknife.h"

namespace dmise {

/// Where a value of a calibrated camera is from.
enum class ValueOrigin {
  measured,       // from the frames
  insignificant,  // measured, but hidden in its deviation: the camera file leaves it out
  header,         // from the header of a frame
  stated,         // by the user
  assumed         // nothing tells it
};
const char* name_of(ValueOrigin origin);

/// One value of a calibrated camera.
struct CameraQuantity {
  std::string key;  // in the camera file, as "detector.gain_e_per_dn"
  std::string unit;
  double value = 0.0;
  std::optional<double> sigma;  // only a measured one has it
  int frames = 0;               // by which it was measured
  ValueOrigin origin = ValueOrigin::measured;
  std::string how;  // short, for the comment beside it
};

/// A table of a camera file over the distance from the middle of the frame.
struct CameraTable {
  struct Column {
    std::string key;  // as "relative_illumination"
    std::vector<MeasuredValue> values;
  };
  std::string key;  // as "optics.vignetting"
  std::vector<double> radius_px;
  std::vector<Column> columns;
  std::string how;
};

/// A camera by its own frames: what its file says, with the deviation of each value.
struct CameraCalibration {
  std::string name, source, projection = "gnomonic", band;
  std::vector<CameraQuantity> quantities;  // in the order of the file
  std::vector<CameraTable> tables;
  std::vector<std::string> notes;

  const CameraQuantity* find(const std::string& key) const;
};

/// The camera file: YAML with the deviation of each value as a comment.
std::string to_yaml(const CameraCalibration& camera);
/// One line of JSON: each quantity with value, sigma, unit, frames and origin; tables; notes.
std::string to_json(const CameraCalibration& camera);
/// Lines for a person: key, value, deviation, unit, where it is from.
std::string to_table(const CameraCalibration& camera);

}  // namespace dmise
