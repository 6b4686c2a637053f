#include "core/detection/aberration.h"

#include "core/sky/apparent.h"

namespace dmise {

Vec<Gcrs> without_annual_aberration(const Vec<Gcrs>& astrometric,
                                    const Vec<Gcrs>& earth_velocity_m_per_s,
                                    const Vec<Gcrs>& sensor_velocity_m_per_s) {
  const Vec<Gcrs> seen = aberrated(astrometric, earth_velocity_m_per_s + sensor_velocity_m_per_s);
  return aberrated(seen, -sensor_velocity_m_per_s);
}

}  // namespace dmise
