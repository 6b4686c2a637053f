#pragma once
#include <functional>
#include <string>
#include <vector>

#include "sensors/accuracy/frame_error.h"

namespace dmise {

/// One way to make a frame, beside the reference. NaN: nothing in the frame can show it.
struct TradeoffRow {
  std::string effect;  // "budget" of a plan
  std::string level;   // level of the effect, or accuracy of the plan
  ErrorBound bound;    // stated by the level or plan
  ErrorBound measured;
  double residual_sigma = 0.0;              // rms over all pixels
  double detected = 0.0;                    // share of the true objects in the frame
  double seconds = 0.0, reference_s = 0.0;  // medians of frames made in turns, without detection
};

/// A line of CSV without its end, and back; nothing for a line that is none. NaN is an empty field.
std::string tradeoff_csv_header();
std::string csv_line(const TradeoffRow& row);
std::optional<TradeoffRow> row_of_csv(const std::string& line);

/// A ladder of levels for each effect and a set of budgets, for one exposure.
class Tradeoff {
 public:
  Tradeoff(const SceneFrames& scene, int repeats);

  /// The rows, yet without what is measured.
  const std::vector<TradeoffRow>& rows() const { return rows_; }
  TradeoffRow measure(std::size_t row) const;
  /// What of the frame's errors cannot be measured, and why; one line each.
  std::vector<std::string> notes() const;

 private:
  const SceneFrames& scene_;
  int repeats_;
  bool has_sources_ = false, has_background_ = false;
  FrameProducts reference_;
  FrameComparison comparison_;
  std::vector<TradeoffRow> rows_;
  std::vector<SensorConfig> sensors_;  // one per row
};

}  // namespace dmise
