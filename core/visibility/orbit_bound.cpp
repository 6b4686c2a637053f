#include "core/visibility/orbit_bound.h"

#include <algorithm>
#include <limits>

namespace dmise {
namespace {

constexpr double mu_m3_per_s2 = 3.986008e14;  // WGS 72, as in SGP4
constexpr double earth_rate_rad_per_s = 7.292115855306587e-5;
constexpr double infinite = std::numeric_limits<double>::infinity();

}  // namespace

OrbitBound orbit_bound(const Vec<Teme>& position_m, const Vec<Teme>& velocity_m_per_s) {
  const double r = norm(position_m), v_squared = dot(velocity_m_per_s, velocity_m_per_s);
  const Vec<Teme> momentum = cross(position_m, velocity_m_per_s);
  const double h_squared = dot(momentum, momentum);
  const double energy = 0.5 * v_squared - mu_m3_per_s2 / r;
  if (!(energy < 0.0) || !(h_squared > 0.0)) return {infinite, infinite, infinite};
  const double axis = -0.5 * mu_m3_per_s2 / energy;
  const double e = std::sqrt(std::max(0.0, 1.0 - h_squared / (mu_m3_per_s2 * axis)));
  const double fastest = mu_m3_per_s2 * (1.0 + e) / std::sqrt(h_squared);
  const double farthest = 1.03 * axis * (1.0 + e);
  // v - w x r|^2 = v^2 - 2 w h_z + (w rho)^2, with rho the distance from the Earth's axis.
  const double w = earth_rate_rad_per_s;
  const double turning =
      1.03 * fastest * fastest - 2.0 * w * momentum.z + w * w * farthest * farthest;
  return {.speed_m_per_s = 1.015 * fastest + 10.0,
          .turning_speed_m_per_s = std::sqrt(std::max(0.0, turning)) + 0.005 * fastest + 10.0,
          .distance_m = farthest};
}

OrbitBound either(const OrbitBound& a, const OrbitBound& b) {
  return {std::max(a.speed_m_per_s, b.speed_m_per_s),
          std::max(a.turning_speed_m_per_s, b.turning_speed_m_per_s),
          std::max(a.distance_m, b.distance_m)};
}

}  // namespace dmise
