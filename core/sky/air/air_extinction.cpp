#include "core/sky/air/air_extinction.h"

#include <vector>

#include "core/effects/plan_facts.h"
#include "core/photometry/magnitude.h"
#include "core/sky/air/airmass.h"
#include "core/sky/air/kept_tables.h"

namespace dmise {

ErrorBound AirExtinction::error(int, const PlanFacts& f) {
  return f.dimmed_by(1.1 * f.zenith_extinction_mag * f.max_airmass);
}

double AirExtinction::cost_s(int level, const PlanFacts& f) { return level * 82e-9 * f.stars; }

AirExtinction::AirExtinction(const AirExposure& exposure) : up_(exposure.up) {
  static KeptTables<std::pair<Band, Curve>, BandExtinction> tables;
  table_ = tables.of({exposure.band, exposure.extinction_mag_per_airmass}, [&] {
    return BandExtinction(exposure.band, exposure.extinction_mag_per_airmass);
  });
}

double AirExtinction::apply(const SightLine& line) const {
  return table_->of_star(airmass_along(up_, line), line.bv);
}

void AirExtinction::apply(const SightLines& lines, std::span<double> factors) const {
  std::vector<double> passed(lines.size());
  table_->of_stars(lines.airmass, lines.bv, passed);
  for (std::size_t i = 0; i < passed.size(); ++i) factors[i] *= passed[i];
}

double AirExtinction::sunlight_mag_per_airmass() const {
  return magnitude_of_light(table_->of_sunlight(1.0));
}

}  // namespace dmise
