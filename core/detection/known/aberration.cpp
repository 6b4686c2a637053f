#include "core/detection/known/aberration.h"

#include <cmath>

#include "core/base/units.h"

namespace dmise {

Vec<Gcrs> aberrated(const Vec<Gcrs>& from, const Vec<Gcrs>& velocity_m_per_s) {
  const Vec<Gcrs> v = velocity_m_per_s / speed_of_light_m_per_s;
  const double inverse_gamma = std::sqrt(1 - dot(v, v));
  const double along = dot(from, v);
  return unit((from * inverse_gamma + v * (1 + along / (1 + inverse_gamma))) / (1 + along));
}

Vec<Gcrs> without_annual_aberration(const Vec<Gcrs>& astrometric,
                                    const Vec<Gcrs>& earth_velocity_m_per_s,
                                    const Vec<Gcrs>& sensor_velocity_m_per_s) {
  const Vec<Gcrs> seen = aberrated(astrometric, earth_velocity_m_per_s + sensor_velocity_m_per_s);
  return aberrated(seen, -sensor_velocity_m_per_s);
}

}  // namespace dmise
