#include "core/sky/air/turbulence.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/units.h"

namespace dmise {
namespace {

double cn2_of(const HufnagelValley& model, double h) {
  const double wind = model.high_wind_m_per_s / 27.0;
  return 0.00594 * wind * wind * std::pow(1e-5 * h, 10) * std::exp(-h / 1000.0) +
         2.7e-16 * std::exp(-h / 1500.0) + model.ground_cn2 * std::exp(-h / 100.0);
}

double cn2_of(const Cn2Table& table, double h) {
  const auto& at = table.height_m;
  if (at.empty() || h < at.front() || h > at.back()) return 0.0;
  const auto above = std::upper_bound(at.begin(), at.end(), h);
  if (above == at.end()) return table.cn2.back();
  const auto i = std::size_t(above - at.begin());
  const double t = (h - at[i - 1]) / (at[i] - at[i - 1]);
  return std::exp(std::log(table.cn2[i - 1]) +
                  t * (std::log(table.cn2[i]) - std::log(table.cn2[i - 1])));
}

void check(const Cn2Table& table) {
  if (table.height_m.size() != table.cn2.size() || table.height_m.size() < 2)
    throw Error("Cn2 table: needs as many values as heights, two or more");
  double last = -1.0;
  for (const double h : table.height_m) {
    if (!(h > last) || !std::isfinite(h)) throw Error("Cn2 table: heights must be >= 0 and ascend");
    last = h;
  }
  for (const double value : table.cn2)
    if (!(value > 0) || !std::isfinite(value)) throw Error("Cn2 table: values must be > 0");
}

/// Heights between which the profile is smooth.
std::vector<double> pieces(const TurbulenceProfile& profile) {
  if (const auto* table = std::get_if<Cn2Table>(&profile)) return table->height_m;
  return {0.0, 200.0, 1000.0, 5000.0, 15000.0, 40000.0};
}

/// Integral of cn2 times f(height), Simpson's rule on each piece: to 1e-7.
template <class F>
double integrate(const TurbulenceProfile& profile, F&& f) {
  constexpr int steps = 200;
  const std::vector<double> edges = pieces(profile);
  double sum = 0.0;
  for (std::size_t i = 1; i < edges.size(); ++i) {
    const double dh = (edges[i] - edges[i - 1]) / steps;
    for (int k = 0; k <= steps; ++k) {
      const double h = k == steps ? edges[i] : edges[i - 1] + k * dh;
      const double weight = k == 0 || k == steps ? 1.0 : (k % 2 ? 4.0 : 2.0);
      sum += weight * dh / 3.0 * cn2(profile, h) * f(h);
    }
  }
  return sum;
}

}  // namespace

double cn2(const TurbulenceProfile& profile, double height_m) {
  return std::visit([&](const auto& p) { return cn2_of(p, height_m); }, profile);
}

double layer_speed_m_per_s(const TurbulenceWind& wind, double height_m, double airmass) {
  const double t = (height_m - 9400.0) / 4800.0;
  const double blown = wind.ground_m_per_s + wind.jet_m_per_s * std::exp(-t * t);
  return std::hypot(blown, wind.slew_rad_per_s * height_m * airmass);
}

Turbulence turbulence(const TurbulenceProfile& profile, double wavelength_m, double airmass,
                      const TurbulenceWind& wind) {
  if (const auto* table = std::get_if<Cn2Table>(&profile)) check(*table);
  if (!(wavelength_m > 0)) throw Error("turbulence: wavelength must be > 0");
  if (!(airmass >= 0.99) || !std::isfinite(airmass))
    throw Error("turbulence: airmass must be >= 0.99");
  const double k2 = 4 * pi * pi / (wavelength_m * wavelength_m);
  const double whole = integrate(profile, [](double) { return 1.0; });
  const double by_height = integrate(profile, [](double h) { return std::pow(h, 5.0 / 3.0); });
  const double by_speed = integrate(profile, [&](double h) {
    return std::pow(layer_speed_m_per_s(wind, h, airmass), 5.0 / 3.0);
  });
  Turbulence result;
  result.r0_m = std::pow(0.423 * k2 * airmass * whole, -0.6);
  result.isoplanatic_angle_rad =
      std::pow(2.914 * k2 * std::pow(airmass, 8.0 / 3.0) * by_height, -0.6);
  result.wind_m_per_s = std::pow(by_speed / whole, 0.6);
  result.tau0_s = result.r0_m / result.wind_m_per_s;
  return result;
}

double scintillation_time_m_s(const BlownTurbulence& turbulence, double airmass) {
  if (const auto* table = std::get_if<Cn2Table>(&turbulence.profile)) check(*table);
  const double whole = integrate(turbulence.profile, [](double) { return 1.0; });
  if (!(whole > 0.0)) return 0.0;
  constexpr double min_m_per_s = 0.1;  // no air stands still
  return integrate(turbulence.profile,
                   [&](double h) {
                     return h * h /
                            std::max(layer_speed_m_per_s(turbulence.wind, h, airmass), min_m_per_s);
                   }) /
         whole;
}

}  // namespace dmise
