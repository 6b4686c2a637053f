#pragma once
#include "core/detector/noise/detector_effect.h"

namespace dmise {

/// Each row is exposed a row time later than the one before. Acts where light is drawn: a source is
/// in its row when that row is open. Row 0 is the first.
struct RollingShutter {
  static constexpr EffectFacts facts{
      "rolling_shutter", "each row is exposed a row time later than the one before",
      "sources are displaced by their rate times the delay of their row",
      "Liang, Chang & Chen 2008, IEEE Trans. Image Processing 17, 1323"};
  double row_time_us = 0.0;  // 0: all rows at once
  bool operator==(const RollingShutter&) const = default;

  static std::span<const ParameterOf<RollingShutter>> parameters();
  static std::optional<DetectorFault> fault(const Detector& detector);
  void switch_off() { row_time_us = 0.0; }
  bool applies(const Detector&) const { return row_time_us > 0.0; }
  static ErrorBound error(int, const PlanFacts&) { return not_bounded; }
  static double cost_s(int level, const PlanFacts& f);
  /// How much later than the first the row at `y_px` is exposed [s]; beyond the frame as its last.
  double row_delay_s(double y_px, int rows) const;
  double last_row_delay_s(int rows) const { return 1e-6 * row_time_us * (rows - 1); }
};

}  // namespace dmise
