#include "core/orbit/kepler.h"

#include <cmath>
#include <numbers>
#include <string>

#include "core/base/error.h"
#include "core/orbit/universal_kepler.h"

namespace dmise {

double eccentric_anomaly_rad(double mean_anomaly_rad, double eccentricity) {
  if (!(eccentricity >= 0 && eccentricity < 1))
    throw Error("eccentricity must be in [0, 1), got " + std::to_string(eccentricity));
  if (!std::isfinite(mean_anomaly_rad))
    throw Error("mean anomaly must be finite, got " + std::to_string(mean_anomaly_rad));
  constexpr long double turn = 2 * std::numbers::pi_v<long double>;
  const long double e = eccentricity;
  const long double turns = std::round(mean_anomaly_rad / turn);
  const long double m = mean_anomaly_rad - turns * turn;
  return static_cast<double>(universal_anomaly({1, 1 - e, e}, m) + turns * turn);
}

}  // namespace dmise
