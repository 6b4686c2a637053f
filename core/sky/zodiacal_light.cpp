#include "core/sky/zodiacal_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "core/base/table_place.h"
#include "core/base/units.h"
#include "core/effects/plan_facts.h"
#include "core/photometry/spectrum.h"

namespace dmise {
namespace {

#include "core/sky/zodiacal_table.inc"

constexpr int rows = std::size(longitude_deg), columns = std::size(latitude_deg);
constexpr double one_s10 = 1.28;

/// Place on an ascending axis whose node below is known for every 5 degrees.
template <int N>
TablePlace place_on(const double (&axis)[N], const std::array<int, 37>& node_at_5_deg,
                    double at_deg) {
  const int node = std::min(node_at_5_deg[std::size_t(at_deg / 5)], N - 2);
  return {std::size_t(node), (at_deg - axis[node]) / (axis[node + 1] - axis[node])};
}

template <int N>
std::array<int, 37> nodes_every_5_deg(const double (&axis)[N]) {
  std::array<int, 37> nodes{};
  for (int k = 0; k < 37; ++k) nodes[k] = int(std::upper_bound(axis, axis + N, 5.0 * k) - axis) - 1;
  return nodes;
}

}  // namespace

ErrorBound ZodiacalLight::error(int, const PlanFacts& f) {
  return f.without_part(SkyPart::zodiacal_light);
}

double ZodiacalLight::cost_s(int level, const PlanFacts& f) {
  return level * 250e-9 * f.sky_looks();
}

double zodiacal_light_s10(double longitude_from_sun_rad, double latitude_rad) {
  static const auto row_at = nodes_every_5_deg(longitude_deg);
  static const auto column_at = nodes_every_5_deg(latitude_deg);
  static const auto logs = [] {
    std::array<std::array<double, columns>, rows> values{};
    for (int i = 0; i < rows; ++i)
      for (int j = 0; j < columns; ++j) values[i][j] = std::log(table[i][j] / one_s10);
    return values;
  }();
  const double longitude =
      std::min(std::abs(std::remainder(longitude_from_sun_rad, 2 * pi)) / deg, 180.0);
  const double latitude = std::min(std::abs(latitude_rad) / deg, 90.0);
  const auto [i, u] = place_on(longitude_deg, row_at, longitude);
  const auto [j, v] = place_on(latitude_deg, column_at, latitude);
  const double low = logs[i][j] + v * (logs[i][j + 1] - logs[i][j]);
  const double high = logs[i + 1][j] + v * (logs[i + 1][j + 1] - logs[i + 1][j]);
  return std::exp(low + u * (high - low));
}

double zodiacal_slope(double angle_from_sun_rad) {
  constexpr double near_rad = 30 * deg, far_rad = 90 * deg, near_slope = 0.8, far_slope = 0.6;
  const double t = (angle_from_sun_rad - near_rad) / (far_rad - near_rad);
  return std::lerp(near_slope, far_slope, std::clamp(t, 0.0, 1.0));
}

double zodiacal_redness(const Band& band) {
  const auto redness = [](double wavelength_m) {
    const double decades = std::log10(std::clamp(wavelength_m, 220 * nm, 2500 * nm) / (500 * nm));
    return decades < 0.0 ? 1.5 * decades : decades;
  };
  const Spectrum reddened = times(solar_spectrum(), [&](double x_m) { return 1.0 + redness(x_m); });
  return photon_rate_per_m2(reddened, band) / photon_rate_per_m2(solar_spectrum(), band) - 1.0;
}

}  // namespace dmise
