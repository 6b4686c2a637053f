#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/base/parallel.h"
#include "sensors/survey/exposure_forecast.h"
#include "sensors/survey/shells.h"

namespace dmise {

/// Exposures in a row in which a sensor sees light of one object; a new pass begins when it was
/// not seen for `pass_gap_s`, and at the start of a night.
struct SurveyPass {
  std::uint32_t object = 0;
  SimTime first, last;          // mid exposures
  std::uint32_t exposures = 0;  // with light of it
  double expected = 0.0;        // number of detections: sum of probabilities
  double log_miss = 0.0;        // logarithm of the probability of none, <= 0
  double best_snr = 0.0;

  bool operator==(const SurveyPass&) const = default;
};
inline constexpr double pass_gap_s = 600.0;

/// A night is a day of the run, counted from its start.
inline constexpr std::int64_t night_ns = 86'400'000'000'000;
inline int night_of(SimTime t) { return int(t.ns / night_ns); }
/// How many nights a run has, the last perhaps shorter.
int nights_of(SimTime duration);

/// What is expected in one exposure.
struct SurveyExposure {
  std::uint32_t frame = 0;
  SimTime middle;
  std::optional<double> sun_elevation_rad;  // at the site, without refraction; none in orbit
  std::uint32_t in_field = 0, sunlit = 0;   // as in `ExposureForecast`
  double expected = 0.0;                    // number of detections

  bool operator==(const SurveyExposure&) const = default;
};

/// A cell of the map: 5 deg of longitude and latitude under the objects, of one shell.
struct MapCell {
  std::uint64_t looks = 0;     // objects with light, summed over the exposures
  std::uint64_t expected = 0;  // detections, in units of 2^-20

  bool operator==(const MapCell&) const = default;
};
inline constexpr int map_columns = 72, map_rows = 36;  // from 180 deg west, from the south
inline constexpr double map_unit = 1.0 / 1048576.0;
/// Shell, row and column.
using MapCells = std::map<std::array<std::uint16_t, 3>, MapCell>;

/// The survey of one sensor over a run.
struct SensorSurvey {
  std::string sensor;
  std::uint32_t frames = 0;               // in the run
  std::uint32_t without_state = 0;        // left out, as platform or target has none
  std::uint32_t closed = 0;               // exposures with the shutter closed
  std::vector<SurveyExposure> exposures;  // at night, in orbit all
  std::vector<SurveyPass> passes;         // by object, then time
  MapCells map;

  bool operator==(const SensorSurvey&) const = default;
};

struct SurveyOptions {
  double night_below_rad = -0.10471975511965977;  // the Sun's elevation at a site, -6 deg
  std::function<void(double share)> progress;     // called from the calling thread
};

/// Whether an exposure is surveyed: in orbit, or at night.
bool is_surveyed(const SurveyScene& scene, const SensorConfig& sensor, std::uint32_t frame,
                 const SurveyOptions& options);

/// Surveys all exposures of a sensor that end within the run. Equal for any number of threads.
/// Throws what `ExposureForecaster` throws.
SensorSurvey survey_sensor(const SurveyScene& scene, const SensorConfig& sensor,
                           const Shells& shells, Threads& threads,
                           const SurveyOptions& options = {});

/// Objects of element sets that may be in the field of frames `first` to `last`, by frame.
std::vector<std::vector<std::uint32_t>> objects_by_frame(const SurveyScene& scene,
                                                         const SensorConfig& sensor,
                                                         const std::vector<std::uint32_t>& frames,
                                                         Threads& threads);

}  // namespace dmise
