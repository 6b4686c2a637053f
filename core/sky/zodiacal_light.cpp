#include "core/sky/zodiacal_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

#include "core/base/numeric/monotone_cubic.h"
#include "core/base/numeric/table_place.h"
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

/// Slopes of a smooth curve through values at an axis, which go on beyond its ends as in a mirror.
template <std::size_t N>
std::array<double, N> slopes(const double (&axis)[N], const std::array<double, N>& value) {
  std::vector<double> at, values;
  const auto add = [&](double place, std::size_t node) {
    at.push_back(place), values.push_back(value[node]);
  };
  add(2 * axis[0] - axis[1], 1);
  for (std::size_t i = 0; i < N; ++i) add(axis[i], i);
  add(2 * axis[N - 1] - axis[N - 2], N - 2);
  const MonotoneCubic curve(std::move(at), std::move(values));
  std::array<double, N> slope;
  std::copy_n(curve.slope().begin() + 1, N, slope.begin());
  return slope;
}

/// The cubic of t in [0, 1] with these values and slopes at its ends.
std::array<double, 4> cubic(double y0, double y1, double slope0, double slope1) {
  return {y0, slope0, 3 * (y1 - y0) - 2 * slope0 - slope1, 2 * (y0 - y1) + slope0 + slope1};
}

double at(const double* c, double t) { return c[0] + t * (c[1] + t * (c[2] + t * c[3])); }

/// The logarithm of the table: bicubic between its nodes, with continuous slopes.
class LogBrightness {
 public:
  LogBrightness() {
    ByNode log, by_longitude, by_latitude, by_both;
    for (int i = 0; i < rows; ++i) {
      for (int j = 0; j < columns; ++j) log[i][j] = std::log(table[i][j] / one_s10);
      by_latitude[i] = slopes(latitude_deg, log[i]);
    }
    for (int j = 0; j < columns; ++j) {
      along_longitude(log, j, by_longitude);
      along_longitude(by_latitude, j, by_both);
    }
    for (int i = 0; i + 1 < rows; ++i)
      for (int j = 0; j + 1 < columns; ++j) {
        const double h = longitude_deg[i + 1] - longitude_deg[i];
        const double k = latitude_deg[j + 1] - latitude_deg[j];
        std::array<std::array<double, 4>, 4> of;  // value, k f_b at v = 0, 1, as cubics of u
        for (int q = 0; q < 2; ++q) {
          of[q] = cubic(log[i][j + q], log[i + 1][j + q], h * by_longitude[i][j + q],
                        h * by_longitude[i + 1][j + q]);
          of[2 + q] = cubic(k * by_latitude[i][j + q], k * by_latitude[i + 1][j + q],
                            h * k * by_both[i][j + q], h * k * by_both[i + 1][j + q]);
        }
        for (int a = 0; a < 4; ++a) {
          const auto c = cubic(of[0][a], of[1][a], of[2][a], of[3][a]);
          std::copy(c.begin(), c.end(), &cells_[i][j][4 * a]);
        }
      }
  }

  /// At (u, v) in [0, 1] of a cell.
  double operator()(std::size_t i, std::size_t j, double u, double v) const {
    const double* c = cells_[i][j].data();
    return at(c, v) + u * (at(c + 4, v) + u * (at(c + 8, v) + u * at(c + 12, v)));
  }

 private:
  using ByNode = std::array<std::array<double, columns>, rows>;

  static void along_longitude(const ByNode& value, int column, ByNode& slope) {
    std::array<double, rows> line;
    for (int i = 0; i < rows; ++i) line[i] = value[i][column];
    line = slopes(longitude_deg, line);
    for (int i = 0; i < rows; ++i) slope[i][column] = line[i];
  }

  std::array<std::array<std::array<double, 16>, columns - 1>, rows - 1> cells_;
};

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
  static const LogBrightness log_brightness;
  const double longitude =
      std::min(std::abs(std::remainder(longitude_from_sun_rad, 2 * pi)) / deg, 180.0);
  const double latitude = std::min(std::abs(latitude_rad) / deg, 90.0);
  const auto [i, u] = place_on(longitude_deg, row_at, longitude);
  const auto [j, v] = place_on(latitude_deg, column_at, latitude);
  return std::exp(log_brightness(i, j, u, v));
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
  const Spectrum reddened =
      times(sunlight_spectrum(), [&](double x_m) { return 1.0 + redness(x_m); });
  return photon_rate_per_m2(reddened, band) / photon_rate_per_m2(sunlight_spectrum(), band) - 1.0;
}

}  // namespace dmise
