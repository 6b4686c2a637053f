#include "core/optics/vignetting.h"

#include <algorithm>
#include <cmath>

#include "core/effects/plan_facts.h"
#include "core/optics/projection.h"

namespace dmise {

ErrorBound Vignetting::error(int, const PlanFacts& f) {
  const double lost = 1.0 - f.min_illumination;
  ErrorBound error = f.without_light([&](const SkySample& s) { return lost * s.sky_e; });
  error.photometry_mag = -2.5 * std::log10(std::max(f.min_illumination, 1e-9));
  // It changes along a source: twice as much at the edge as on the way there.
  double length_px = f.longest_trail_px;
  for (const double radius_px : f.shape_radius_px) length_px = std::max(length_px, 2.0 * radius_px);
  const double half_diagonal_px = 0.5 * std::hypot(double(f.columns), double(f.rows));
  const double change = std::max(lost * std::min(1.0, 2.0 * length_px / half_diagonal_px),
                                 std::min(1.0, f.illumination_slope_per_px * length_px));
  error.position_px = 0.25 * change * length_px;
  // Where a source leaves less than half of the noise.
  if (f.stars > 0.0 || f.objects > 0)
    error += f.without_light([&](const SkySample& s) { return 0.5 * lost * s.noise_e; });
  return error;
}

double Vignetting::cost_s(int level, const PlanFacts& f) { return level * 10e-9 * f.stars; }

double relative_illumination(const Optics& optics, PixelPosition pixel) {
  const Vignetting& v = optics.vignetting;
  if (!v.any()) return 1.0;
  if (!v.table.empty()) {
    const auto radius = field_radius(optics, pixel, v.table_radius);
    return radius ? std::clamp(v.table(*radius), 0.0, 1.0) : 0.0;
  }
  double share = 1.0;
  if (v.natural) {
    const auto direction = unproject(optics, pixel);
    share = direction ? std::max(0.0, direction->z) : 0.0;
  }
  if (v.corner < 1.0) {
    const PixelPosition d = pixel - principal_point(optics);
    const double r = std::min(1.0, std::hypot(d.x_px, d.y_px) / corner_px(optics));
    share *= 1.0 - (1.0 - v.corner) * std::pow(r, v.power);
  }
  return share;
}

double illumination_slope_per_px(const Optics& optics) {
  const Vignetting& v = optics.vignetting;
  if (v.table.empty()) return 0.0;
  constexpr int steps = 256;
  constexpr double darkest = 1e-3;
  double steepest = 0.0, before = -1.0;
  const double step_px = corner_px(optics) / steps;
  for (int i = 0; i <= steps; ++i) {
    const auto radius = field_radius_at(optics, i * step_px, v.table_radius);
    const double here = radius ? std::clamp(v.table(*radius), 0.0, 1.0) : 0.0;
    if (before >= 0.0)
      steepest = std::max(steepest, std::abs(here - before) / step_px / std::max(here, darkest));
    before = here;
  }
  return steepest;
}

}  // namespace dmise
