#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/files/json_record.h"
#include "core/config/scenario.h"
#include "sensors/scene/frame_times.h"

namespace dmise {

/// Where a camera points during an exposure: with the stars, or fixed to the ground.
struct CommandedPointing {
  bool follows = false;        // the stars
  double longitude_deg = 0.0;  // right ascension of its axis (GCRS axes), or azimuth
  double latitude_deg = 0.0;   // declination, or elevation
  double longitude_rate_deg_per_s = 0.0, latitude_rate_deg_per_s = 0.0;  // 0 unless it follows
  SimTime reference;      // when it points there, if it follows
  double roll_deg = 0.0;  // as `SensorConfig::roll_deg`

  bool operator==(const CommandedPointing&) const = default;
};

/// The part of a frame that a client takes, in binned pixels.
struct Window {
  int bin_x = 1, bin_y = 1;
  int x = 0, y = 0;
  int columns = 0, rows = 0;

  bool operator==(const Window&) const = default;
};

/// One exposure on command, with all that its frame depends on beside the scenario.
struct CommandedExposure {
  std::string sensor;
  std::uint32_t frame = 1;  // counts the sensor's frames from 1
  SimTime start, length;
  CommandedPointing pointing;
  Window window;               // which the client took; the frame is whole
  int gain = 0, offset = 0;    // places among those of the camera, which has one of each
  double temperature_c = 0.0;  // temperature of the detector
  int filter = 0;              // place in the camera's wheel
  double focus_um = 0.0;       // way of the detector from where the camera file has it
  bool dark = false;           // behind a closed cover or shutter

  FrameTimes times() const { return {frame, start, {start.ns + length.ns / 2}, start + length}; }
  bool operator==(const CommandedExposure&) const = default;
};

inline constexpr double max_commanded_exposure_s = 3600.0, min_commanded_exposure_s = 0.001;
inline constexpr double max_rate_deg_per_s = 10.0;  // in right ascension and in declination
inline constexpr int max_bin = 8;

/// One line of night.jsonl, without its end.
std::string to_json(const CommandedExposure& exposure);

/// Reads a line of night.jsonl. Throws `ConfigError` "FILE:LINE: KEY: reason" for what no
/// observatory of the scenario writes.
CommandedExposure read_commanded_exposure(const JsonRecord& line, const Scenario& scenario);

/// Reads a night's exposures; a last line without its end was interrupted and is none. Throws
/// `ConfigError`, also where a sensor's frames do not count from 1.
std::vector<CommandedExposure> read_night(const std::string& path, const Scenario& scenario);

/// Returns the sensor as it makes the frame of an exposure, in the band that it has.
SensorConfig commanded_sensor(const SensorConfig& sensor, const CommandedExposure& exposure);

/// Whether a scenario covers an exposure, whatever the sensor's clock.
bool is_within_run(const Scenario& scenario, const SensorConfig& sensor, const FrameTimes& times);

}  // namespace dmise
