#include "core/detector/rolling_shutter.h"

#include <algorithm>

#include "core/detector/detector.h"
#include "core/effects/plan_facts.h"

namespace dmise {

double RollingShutter::cost_s(int level, const PlanFacts& f) {
  return level * (0.3e-6 * f.stars + 60e-6 * double(f.objects));
}

std::span<const ParameterOf<RollingShutter>> RollingShutter::parameters() {
  static constexpr ParameterOf<RollingShutter> table[] = {
      {"row_time_us", "ROWTIME", "[us] a row is exposed later than the one before",
       &RollingShutter::row_time_us, 0.0, 1e5}};
  return table;
}

std::optional<DetectorFault> RollingShutter::fault(const Detector& d) {
  if (d.row_time_us == 0.0 || d.frame_transfer_s == 0.0) return std::nullopt;
  return DetectorFault{"row_time_us", "must be 0 with frame_transfer_s: one shutter or the other",
                       d.row_time_us};
}

double RollingShutter::row_delay_s(double y_px, int rows) const {
  return 1e-6 * row_time_us * std::clamp(y_px, 0.0, double(rows - 1));
}

}  // namespace dmise
