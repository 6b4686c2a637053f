#pragma once
#include <optional>
#include <string>
#include <vector>

#include "bench/validation/drawn_frames.h"
#include "core/image/charts/chart.h"

namespace dmise {

/// A sum of errors of detections.
struct ErrorSum {
  std::size_t count = 0;
  double sum = 0.0, squares = 0.0;
  void add(const std::optional<double>& value);
  double mean() const { return count ? sum / double(count) : 0.0; }
  double rms() const;
};

/// Truths of a range of SNR.
struct SnrRow {
  Bin bin;                             // by the scorer
  double expected = 0.0;               // found, by the model of `dmise survey`
  ErrorSum across_sigma, along_sigma;  // position over its stated sigma
  ErrorSum magnitude, magnitude_sigma;
};

/// As the tracking branch of LLNL's SImSiT scores.
struct SimsitFigures {
  double completeness = 0.0, false_positive_rate = 0.0;
  double xy_rmse_px = 0.0, flux_rmse_mag = 0.0;
};

/// Points with an SNR of 12 and more, by their distance to the nearest trail of a star.
struct DistanceRow {
  double to_px = 0.0;  // from where the row before ends
  std::size_t truths = 0, found = 0;
};

/// What is found in the drawn frames of one sensor.
struct DetectorFigures {
  std::string sensor;
  std::size_t frames = 0;
  std::vector<SnrRow> rows;  // that have truths
  SnrRow all;
  std::vector<DistanceRow> by_star_px;  // points only
  double false_alarms_a_frame = 0.0;
  double across_arcsec = 0.0, along_arcsec = 0.0;  // rms, of clean detections
  SimsitFigures simsit;
  double sigma_found = 0.0;  // scatter of the number found, if the model is right
  double deviation_sigma() const;
};

std::vector<DetectorFigures> detector_figures(const ScoredDraws& drawn);

/// Their section of the page in Markdown; `pictures`: the folder of its charts.
std::string detector_section(const std::vector<DetectorFigures>& sensors,
                             const std::string& pictures);

/// Completeness over SNR of the frames of `kind`: `streak_sensor` or `point_sensor`.
Chart completeness_chart(const std::vector<DetectorFigures>& sensors, const std::string& kind);

}  // namespace dmise
