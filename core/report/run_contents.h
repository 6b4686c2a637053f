#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/products/detection.h"
#include "core/products/found_breakup.h"
#include "core/products/task.h"
#include "core/products/track.h"
#include "core/products/truth.h"
#include "core/run/run_record.h"
#include "core/score/score.h"

namespace dmise {

/// What an effect cost a sensor, summed over its frames.
struct EffectCost {
  std::map<std::string, std::size_t> levels;  // frames at each; empty without a plan
  std::string why;                            // why it had its first decided level
  std::size_t planned_frames = 0;             // that predict a cost
  double predicted_s = 0.0, measured_s = 0.0;
};

struct ReportSensor {
  RunSensor sensor;
  std::size_t frames = 0, detections = 0;
  double seconds_per_frame = 0.0, memory_mb = 0.0;
  std::size_t costs = 0;  // frames of which the cost is known
  std::map<std::string, EffectCost> effects;
  std::string log;  // its path from the run's directory; empty: none
};

struct ReportFrame {
  std::size_t sensor = 0;
  std::uint32_t number = 0;
  SimTime middle;  // mid exposure
  std::string middle_utc;
  double boresight_ra_rad = 0.0, boresight_dec_rad = 0.0;
  Vec<Gcrs> sensor_position_m;
  std::optional<double> limiting_magnitude;  // V-solar, whatever the system of the camera
  std::optional<double> background_e, noise_e, total_s, predicted_s;
  std::size_t stars_found = 0, stars_expected = 0;
  std::string fits, picture, marked;  // paths from the run's directory; empty: not there
};

struct ReportTruth {
  std::size_t frame = 0;
  Truth truth;
  std::size_t scored = 0;  // in Score::truths
};

struct ReportDetection {
  std::size_t frame = 0;
  Detection detection;
  bool of_truth = false;
};

/// A track, as far as it is drawn.
struct ReportTrack {
  Track last;
  double first_s = 0.0;
  std::size_t cues = 0;
  std::vector<std::pair<double, double>> sigma_m;  // time [s], standard deviation of its position
};

/// What a clock did with a tick, seconds since its first.
struct ReportTick {
  Tick tick = 0;
  double granted_s = 0.0, settled_s = 0.0;
  std::string last;  // the node that all others waited for
};

/// The products of a run, complete or not.
struct RunContents {
  std::string directory;
  RunRecord record;                   // its digest alone if the run was killed as it began
  std::vector<ReportSensor> sensors;  // in the record, or known by frames that they left
  std::vector<ReportFrame> frames;    // by sensor and number
  std::vector<ReportTruth> truths;    // only objects that may have light in a frame
  std::vector<ReportDetection> detections;
  bool has_truth = false;
  Score score;
  std::vector<ReportTrack> tracks;
  std::vector<Task> cues;
  std::vector<FoundBreakup> breakups;  // the last line of each
  std::vector<ReportTick> ticks;
  std::map<std::string, double> waited_for_s;  // in which the clock waited for a node
  std::vector<std::string> files;              // products and logs, paths from the directory
};

/// Reads what is in a run's directory: the lines of each sensor, also of a run that was
/// interrupted or has not ended. Throws `ConfigError` "FILE:LINE: KEY: reason" for what is invalid,
/// and if no sensor has left a frame.
RunContents read_contents(const std::string& directory);

}  // namespace dmise
