#include "core/optics/focus_drift.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/effects/plan_facts.h"

namespace dmise {
namespace {

constexpr double hour_s = 3600.0, day_h = 24.0;

double day_angle_rad(double hours) { return 2 * pi * hours / day_h; }

}  // namespace

ErrorBound FocusDrift::error(int level, const PlanFacts& f) {
  if (level > 0) return {};
  // A disc of the blur's own width moves half of the light.
  const double discs = f.defocus_px / std::hypot(f.fwhm_px, 0.5);
  return f.misplaced(0.5 * discs * std::max(1.0, discs), 0.0);
}

double FocusDrift::cost_s(int level, const PlanFacts& f) { return level * f.kernel_s; }

double FocusDrift::at_m(double time_s) const {
  const double hours = time_s / hour_s;
  const double warmer_k =
      0.5 * swing_k *
      (std::cos(day_angle_rad(hours - warmest_h)) - std::cos(day_angle_rad(warmest_h)));
  return 1e-6 * (start_um + um_per_hour * hours + um_per_k * warmer_k);
}

double FocusDrift::max_m() const {
  constexpr int steps = 1440;
  // What a cosine may rise above the larger of two of its points.
  const double step_rad = day_angle_rad(run_s / hour_s / steps);
  double most = 0.0625 * std::min(step_rad * step_rad, 16.0) * 1e-6 * std::abs(um_per_k * swing_k);
  const double slack = most;
  for (int i = 0; i <= steps; ++i) most = std::max(most, std::abs(at_m(run_s * i / steps)) + slack);
  return any() ? most : 0.0;
}

std::span<const FocusParameter> focus_parameters() {
  static constexpr double any_um = 1e5;
  static constexpr FocusParameter table[] = {
      {"start_um", "[um] distance of the detector from the focus at the start of the run",
       &FocusDrift::start_um, -any_um, any_um},
      {"um_per_hour", "[um/h] by which it grows with time", &FocusDrift::um_per_hour, -1e4, 1e4},
      {"um_per_k", "[um/K] by which it grows with the temperature", &FocusDrift::um_per_k, -1e4,
       1e4},
      {"swing_k", "[K] between the lowest and the highest temperature of a day",
       &FocusDrift::swing_k, 0.0, 500.0},
      {"warmest_h", "[h] from the start of the run to the highest temperature",
       &FocusDrift::warmest_h, 0.0, 24.0}};
  return table;
}

}  // namespace dmise
