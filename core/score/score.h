#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/score/intervals.h"
#include "core/score/score_input.h"

// Joins detections and truth; no other code does.
namespace dmise {

struct ScoreSettings {
  double gate_px = 5.0;        // see association.h
  double threshold_snr = 6.0;  // the detector's: theory is Q(threshold - SNR)
};

/// What became of a truth; each has one.
enum class Fate {
  found,
  missed,    // expected above the threshold, or unknown
  faint,     // not found, expected below the threshold
  dark,      // enters the frame without light: in shadow or hidden
  outside,   // neither light nor a part of the trail is in the frame
  unscored,  // its frame is missing, or was not searched
};
inline constexpr std::array fate_names = {"found", "missed",  "faint",
                                          "dark",  "outside", "unscored"};

/// Errors of a detection, measured - true. Along and across the true trail and the streak on the
/// sky; of points along x and y, and to the east and north.
struct MatchErrors {
  std::optional<double> along_px, across_px;          // centroid of light
  std::optional<double> along_arcsec, across_arcsec;  // corrected direction at mid exposure
  std::optional<double> nees_px, nees_sky;            // squared errors over their covariance, / 2
  std::optional<double> over_bound;                   // across_px / its Cramer-Rao bound
  std::optional<double> magnitude, magnitude_over_sigma;  // if the detection is in V
  std::optional<double> flux, flux_over_sigma;            // -2.5 log10(signal / true) [mag]
  // Ends of streaks, of trails that are whole: beyond the true one, across, and in time.
  std::optional<double> start_along_px, start_across_px, start_time_s;
  std::optional<double> end_along_px, end_across_px, end_time_s;
};

struct ErrorKey {
  const char* key;
  const char* what;
  std::optional<double> MatchErrors::*value;
};
/// The table of errors: text, JSON and CSV follow it.
inline constexpr std::array error_keys = {
    ErrorKey{"along_px", "position along the trail (points: x) [px]", &MatchErrors::along_px},
    ErrorKey{"across_px", "position across it (points: y) [px]", &MatchErrors::across_px},
    ErrorKey{"along_arcsec", "direction along it (points: east) [arcsec]",
             &MatchErrors::along_arcsec},
    ErrorKey{"across_arcsec", "direction across it (points: north) [arcsec]",
             &MatchErrors::across_arcsec},
    ErrorKey{"nees_px", "NEES / 2 of the centroid", &MatchErrors::nees_px},
    ErrorKey{"nees_sky", "NEES / 2 of the direction", &MatchErrors::nees_sky},
    ErrorKey{"over_bound", "position across / Cramer-Rao bound", &MatchErrors::over_bound},
    ErrorKey{"magnitude", "magnitude V", &MatchErrors::magnitude},
    ErrorKey{"magnitude_over_sigma", "magnitude / sigma", &MatchErrors::magnitude_over_sigma},
    ErrorKey{"flux", "electrons in the frame [mag]", &MatchErrors::flux},
    ErrorKey{"flux_over_sigma", "electrons [mag] / sigma", &MatchErrors::flux_over_sigma},
    ErrorKey{"start_along_px", "start beyond the true one [px]", &MatchErrors::start_along_px},
    ErrorKey{"start_across_px", "start across the trail [px]", &MatchErrors::start_across_px},
    ErrorKey{"start_time_s", "time at the start [s]", &MatchErrors::start_time_s},
    ErrorKey{"end_along_px", "end beyond the true one [px]", &MatchErrors::end_along_px},
    ErrorKey{"end_across_px", "end across the trail [px]", &MatchErrors::end_across_px},
    ErrorKey{"end_time_s", "time at the end [s]", &MatchErrors::end_time_s},
};

struct ScoredTruth {
  TrueSource truth;
  Fate fate = Fate::unscored;
  std::optional<double> snr;  // expected, see matched_filter.h
  double length_px = 0.0;     // part of the trail in the frame
  std::optional<double> rate_arcsec_per_s;
  std::optional<Detection> detection;
  std::size_t pieces = 0;  // detections of it
  bool clean = false;      // whole, no shape, in one piece, neither saturated nor at the edge
  MatchErrors errors;

  bool is_point() const { return length_px < 2.0; }
  bool has_light() const { return fate <= Fate::faint; }
  /// Whether its expected SNR is above a threshold or unknown.
  bool is_above(double threshold_snr) const {
    return has_light() && (!snr || *snr >= threshold_snr);
  }
};

/// Truths with light whose `key` is in [from, to), and how many were found.
struct Bin {
  std::optional<double> from, to;  // empty: no bound
  std::size_t truths = 0, found = 0;
  Interval probability;
  std::optional<double> theory;  // mean of Q over them
};

struct ErrorFigure {
  std::size_t count = 0;
  double mean = 0.0, rms = 0.0;
};

struct SensorScore {
  std::string sensor;  // empty: all
  std::size_t frames = 0, unsearched_frames = 0;
  double megapixels = 0.0;                             // searched
  std::array<std::size_t, fate_names.size()> fates{};  // by Fate
  std::size_t truths = 0, detections = 0;
  std::size_t in_pieces = 0, further_pieces = 0;  // truths found in pieces; detections beyond one
  std::size_t false_alarms = 0, unscored_detections = 0;
  Bin detection;  // truths expected above the threshold, or unknown
  std::vector<Bin> by_snr, by_magnitude, by_length_px, by_rate;  // last two: above the threshold
  std::optional<double> points_threshold, streaks_threshold;     // fitted within 4 of the setting
  // Clean detections, then all; points, then streaks.
  std::array<std::array<std::array<ErrorFigure, error_keys.size()>, 2>, 2> errors{};
};

struct Score {
  ScoreSettings settings;
  std::string source, status;
  std::vector<SensorScore> sensors;       // by name, then their total
  std::vector<ScoredTruth> truths;        // by sensor, frame and name
  std::vector<FoundSource> false_alarms;  // by sensor, frame and SNR
};

/// The result does not depend on the order of the lists. Throws `Error` if a frame is there twice.
Score score(ScoreInput input, const ScoreSettings& settings);

}  // namespace dmise
