#include "core/sky/stars/star_counts.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/numeric/table_place.h"
#include "core/base/units.h"
#include "core/photometry/magnitude.h"

namespace dmise {
namespace {

constexpr int latitudes = 8, longitudes = 13, magnitudes = 13;
constexpr std::array<double, latitudes> latitude_deg = {0, 5, 10, 20, 30, 45, 60, 90};
constexpr double longitude_step_deg = 15.0, dustless_from_deg = 20.0, faintest_v_mag = 25.0;

/// log10 of stars per square degree brighter than V = 9, 10, ... 21 over longitude, by
/// `latitude_deg`. Made by tests/reference/star_counts.py --table.
constexpr double mean_log_n[magnitudes][latitudes] = {
#include "core/sky/stars/star_counts_table.inc"
};

/// The fit of Bahcall & Soneira 1980, appendix B, stars per square degree brighter than V.
double dustless(double v_mag, double longitude_rad, double latitude_rad) {
  const double mu = std::clamp(0.0075 * (v_mag - 12) + 0.03, 0.03, 0.09);
  const double gamma = std::clamp(0.04 * (12 - v_mag) + 0.36, 0.04, 0.36);
  const double sin_b = std::sin(latitude_rad), cos_b = std::cos(latitude_rad);
  const double towards = cos_b * std::cos(longitude_rad);
  const double disc = 925 * std::pow(10, 0.035 * (v_mag - 15.75)) /
                      std::pow(1 + std::pow(10, -0.132 * (v_mag - 15.75)), 3.0) /
                      std::pow(sin_b - mu * towards, 3 - 5 * gamma);
  const double spheroid = 1050 * std::pow(10, 0.087 * (v_mag - 17.5)) /
                          std::pow(1 + std::pow(10, -0.18 * (v_mag - 17.5)), 2.5) /
                          std::pow(1 - towards, 1.45 - 0.2 * towards);
  return disc + spheroid;
}

/// log10 N at the nodes of latitude and longitude.
struct Table {
  double log_n[latitudes][longitudes][magnitudes];

  Table() {
    for (int b = 0; b < latitudes; ++b) {
      const double latitude_rad = std::max(latitude_deg[b], dustless_from_deg) * deg;
      for (int m = 0; m < magnitudes; ++m) {
        const double v_mag = StarCounts::first_v_mag + m;
        double mean = 0.0, n[longitudes];
        for (int l = 0; l < longitudes; ++l) {
          n[l] = dustless(v_mag, l * longitude_step_deg * deg, latitude_rad);
          mean += (l == 0 || l == longitudes - 1 ? 0.5 : 1.0) * n[l] / (longitudes - 1);
        }
        for (int l = 0; l < longitudes; ++l)
          log_n[b][l][m] = mean_log_n[m][b] + std::log10(n[l] / mean);
      }
    }
  }
};

const Table& table() {
  static const Table made;
  return made;
}

}  // namespace

StarCounts::StarCounts(const Vec<Galactic>& direction) {
  static_assert(nodes == magnitudes);
  const double b_deg = std::asin(std::clamp(std::abs(direction.z), 0.0, 1.0)) / deg;
  const double l_deg = std::abs(std::atan2(direction.y, direction.x)) / deg;
  int row = 0;
  while (row < latitudes - 2 && b_deg > latitude_deg[row + 1]) ++row;
  const double down = (b_deg - latitude_deg[row]) / (latitude_deg[row + 1] - latitude_deg[row]);
  const auto [column, along] = table_place(l_deg / longitude_step_deg, longitudes);
  const auto& t = table().log_n;
  for (int m = 0; m < nodes; ++m)
    log_n_[m] = (1 - down) * ((1 - along) * t[row][column][m] + along * t[row][column + 1][m]) +
                down * ((1 - along) * t[row + 1][column][m] + along * t[row + 1][column + 1][m]);
}

/// Slope of log10 N in the step that begins at or before a magnitude.
double StarCounts::slope_at(double v_mag) const {
  const int step = std::clamp(int(std::floor(v_mag - first_v_mag)), 0, nodes - 2);
  return log_n_[step + 1] - log_n_[step];
}

double StarCounts::brighter_than(double v_mag) const {
  const int step = std::clamp(int(std::floor(v_mag - first_v_mag)), 0, nodes - 2);
  return std::pow(10.0, log_n_[step] + (v_mag - first_v_mag - step) * slope_at(v_mag));
}

double StarCounts::light_s10(double from, double to) const {
  double light = 0.0;
  while (from < to) {
    const double end = from < first_v_mag  ? std::min(to, first_v_mag)
                       : from < last_v_mag ? std::min(to, std::floor(from) + 1.0)
                                           : to;
    // dN = N ln 10 s dm, each with 10^(-0.4 (m - 10)).
    const double s = slope_at(from), k = (s - 0.4) * std::log(10.0);
    const double at_from = brighter_than(from) * light_of_magnitude(from - 10.0);
    const double width = end - from;
    const double integral = std::abs(k * width) < 1e-9 ? width : std::expm1(k * width) / k;
    light += at_from * std::log(10.0) * s * integral;
    from = end;
  }
  return light;
}

double StarCounts::magnitude_of(double from, double to, double share) const {
  const double k = slope_at(from) * std::log(10.0);
  const double width = to - from;
  if (std::abs(k * width) < 1e-9) return from + share * width;
  return from + std::log1p(share * std::expm1(k * width)) / k;
}

namespace {

/// log10 of the stars of the whole sky by half magnitudes from V = 0 on.
constexpr std::size_t half_magnitudes = 51;
std::array<double, half_magnitudes> log_of_all_sky() {
  constexpr int bands = 60, meridians = 48;
  std::array<double, half_magnitudes> sum{};
  for (int i = 0; i < bands; ++i)
    for (int k = 0; k < meridians; ++k) {
      const double z = (i + 0.5) / bands, l = (k + 0.5) * pi / meridians;  // a quarter of the sky
      const double level = std::sqrt(1.0 - z * z);
      const StarCounts counts(Vec<Galactic>{level * std::cos(l), level * std::sin(l), z});
      for (std::size_t m = 0; m < sum.size(); ++m) sum[m] += counts.brighter_than(0.5 * double(m));
    }
  for (double& n : sum) n = std::log10(n / (bands * meridians) * 4.0 * pi / (deg * deg));
  return sum;
}

}  // namespace

double stars_of_all_sky(double v_mag) {
  static const std::array<double, half_magnitudes> log_n = log_of_all_sky();
  const auto [place, along] = table_place(2.0 * v_mag, int(half_magnitudes));
  return std::pow(
      10.0, (1.0 - along) * log_n[std::size_t(place)] + along * log_n[std::size_t(place) + 1]);
}

double starlight_of_counts_s10(double v_mag, const Vec<Galactic>& direction) {
  return v_mag < faintest_v_mag ? StarCounts(direction).light_s10(v_mag, faintest_v_mag) : 0.0;
}

}  // namespace dmise
