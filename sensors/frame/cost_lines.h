#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "sensors/frame/frame_pipeline.h"

namespace dmise {

/// Frames from the first on that have a line each in cost.jsonl.
inline constexpr std::uint32_t frames_with_own_cost = 1000;

/// Frames that share a line which begins with or after `frame`: 1, 2 from `frames_with_own_cost`
/// on, 4 from twice as many on, and so forth, so that a file has 500 lines more for twice as many
/// frames.
std::uint32_t frames_of_cost_line(std::uint32_t frame);

/// Makes the lines of cost.jsonl. Each is named by its last frame and has the means over its
/// `frames`, if these are several, and the largest memory. A frame whose plan has other levels than
/// the line before has a line of its own: frames without one have the plan of the line before.
class CostLines {
 public:
  /// Adds a frame, and returns the lines that are complete.
  std::string add(const FrameProducts& frame, double pss_mb);
  /// Returns the line of frames that have none yet; "" if there are none.
  std::string take();

 private:
  using Levels = std::vector<std::pair<const EffectFacts*, int>>;

  std::string sensor_;
  std::uint32_t last_frame_ = 0, frames_ = 0;  // newest frame, number of frames
  double total_s_ = 0.0, detection_s_ = 0.0, pss_mb_ = 0.0;
  std::vector<double> effects_s_;  // in the order of all_effects()
  EffectPlan plan_;                // as the last frame had it
  Levels levels_;                  // as the last line said
};

}  // namespace dmise
