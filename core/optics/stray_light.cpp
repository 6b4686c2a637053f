#include "core/optics/stray_light.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/effects/plan_facts.h"

namespace dmise {

ErrorBound StrayLight::error(int, const PlanFacts& f) {
  return f.without_light([&](const SkySample&) { return f.stray_light_e; });
}

double StrayLight::cost_s(int level, const PlanFacts& f) { return level * 0.5e-9 * f.pixels(); }

double StrayLight::at(double angle_rad) const {
  if (!any()) return 0.0;
  const double angle = angle_rad / deg;
  const auto next = std::upper_bound(angle_deg.begin(), angle_deg.end(), angle);
  if (next == angle_deg.begin()) return transmittance.front();
  if (next == angle_deg.end()) return transmittance.back();
  const auto i = std::size_t(next - angle_deg.begin());
  const double t = (angle - angle_deg[i - 1]) / (angle_deg[i] - angle_deg[i - 1]);
  const double a = transmittance[i - 1], b = transmittance[i];
  return a > 0.0 && b > 0.0 ? a * std::pow(b / a, t) : a + t * (b - a);
}

}  // namespace dmise
