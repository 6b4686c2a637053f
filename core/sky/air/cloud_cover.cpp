#include "core/sky/air/cloud_cover.h"

#include "core/effects/plan_facts.h"
#include "core/sky/air/kept_tables.h"

namespace dmise {

double CloudCover::cost_s(int level, const PlanFacts& f) { return level * 300e-9 * f.stars; }

CloudCover::CloudCover(const AirExposure& exposure)
    : enu_from_gcrs_(exposure.enu_from_gcrs), time_s_(exposure.time_s) {
  static KeptTables<Clouds, CloudMap> maps;
  map_ = maps.of(*exposure.clouds, [&] { return CloudMap(*exposure.clouds); });
}

}  // namespace dmise
