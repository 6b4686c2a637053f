#include "core/optics/thermal_optics.h"

#include "core/effects/plan_facts.h"

namespace dmise {

ErrorBound ThermalOptics::error(int, const PlanFacts& f) {
  return f.without_charge(f.thermal_optics_e);
}

double ThermalOptics::cost_s(int level, const PlanFacts& f) {
  return level * (1e-9 * f.pixels() + 0.2e-6 * f.sky_looks());
}

}  // namespace dmise
