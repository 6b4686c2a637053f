#pragma once
#include <string>
#include <vector>

#include "core/score/score.h"

namespace dmise {

/// Counts what became of a sensor's frames, truths and detections.
class SensorTally {
 public:
  SensorTally(const std::string& sensor, const ScoreSettings& settings);
  void add(const ScoredFrame& frame);
  void add(const ScoredTruth& truth);
  /// `scored`: its frame exists and was searched.
  void add(const FoundSource& detection, bool scored);
  /// The figures of all that was added; ends the tally.
  SensorScore finish();

 private:
  void add_to(std::vector<Bin>& bins, std::optional<double> value, const ScoredTruth& truth) const;

  ScoreSettings settings_;
  SensorScore score_;
  std::vector<Bin> above_ = std::vector<Bin>(1);
  std::vector<DetectionTrial> trials_[2];  // points, streaks
};

}  // namespace dmise
