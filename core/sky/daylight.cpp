#include "core/sky/daylight.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/effects/plan_facts.h"
#include "core/sky/air/kept_tables.h"

namespace dmise {

ErrorBound Daylight::error(int, const PlanFacts& f) { return f.without_part(SkyPart::daylight); }

double Daylight::cost_s(int level, const PlanFacts& f) {
  constexpr double table_s = 30e-3, look_s = 250e-9;
  return f.scene.daylight ? level * (table_s + look_s * f.sky_looks()) : 0.0;
}

double daylight_share(double sun_altitude_rad) {
  const double t = std::clamp(1.0 - sun_altitude_rad / daylight_from_rad, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

std::shared_ptr<const DaySky> kept_day_sky(const Band& band, const DayAir& air,
                                           double sin_sun_altitude) {
  struct Key {
    Band band;
    DayAir air;
    double sin_sun_altitude;
    bool operator==(const Key&) const = default;
  };
  static KeptTables<Key, DaySky> skies;
  return skies.of({band, air, sin_sun_altitude},
                  [&] { return DaySky(band, air, sin_sun_altitude); });
}

}  // namespace dmise
