#include "core/sky/air/sunlit_air.h"

#include <algorithm>
#include <cmath>

#include "core/base/numeric/table_place.h"
#include "core/base/units.h"
#include "core/photometry/magnitude.h"
#include "core/photometry/spectrum.h"
#include "core/sky/air/standard_air.h"

namespace dmise {
namespace {

// Columns by height, every 1 km, and by the zenith angle: even steps of c / (c + horizon), c its
// cosine. Stored is the column times c + horizon over that towards the zenith, which varies little.
constexpr double height_step_m = 1e3, horizon = 0.06;
constexpr std::size_t heights = std::size_t(AirColumns::top_m / height_step_m) + 1, angles = 48;

// Light by columns of air and ozone [atm-cm]: even steps of the root.
constexpr double max_air = 400.0, max_ozone = 60.0;
constexpr std::size_t airs = 64, ozones = 32;
constexpr double darkest = -200.0;  // logarithm that stands for no light

/// Along a straight line, by steps that grow with the way.
AirColumn column_along(double height_m, double cos_zenith) {
  constexpr int steps = 120;
  const double r = AirColumns::earth_radius_m + height_m;
  const double top_m = std::max(AirColumns::top_m, height_m + 1.0);
  const double farthest_m =
      std::sqrt(r * r * cos_zenith * cos_zenith +
                (top_m - height_m) * (top_m + 2 * AirColumns::earth_radius_m + height_m)) -
      r * cos_zenith;
  AirColumn sum;
  for (int i = 0; i < steps; ++i) {
    const double x = (i + 0.5) / steps, s = farthest_m * x * x;
    const double z = std::sqrt(r * r + s * s + 2 * r * s * cos_zenith) - AirColumns::earth_radius_m;
    const double step_m = farthest_m * 2 * x / steps;
    sum.air += step_m * relative_density(z);
    sum.ozone += step_m * ozone_density(z);
  }
  return sum;
}

}  // namespace

const AirColumns& AirColumns::standard() {
  static const AirColumns columns;
  return columns;
}

AirColumns::AirColumns() {
  column_m_ = column_along(0.0, 1.0).air;
  for (std::size_t i = 0; i < heights; ++i) {
    const double height_m = height_step_m * double(i);
    AirColumn up = column_along(height_m, 1.0);
    up.air = std::max(up.air / column_m_, 1e-12);
    up.ozone = std::max(up.ozone, 1e-30);
    log_up_.push_back({std::log(up.air), std::log(up.ozone)});
    for (std::size_t k = 0; k < angles; ++k) {
      const double v = double(k) / (angles - 1) / (1.0 + horizon);
      const double cosine = std::min(1.0, horizon * v / (1.0 - v));
      const AirColumn to = column_along(height_m, cosine);
      stretched_.push_back({(cosine + horizon) * to.air / column_m_ / up.air,
                            (cosine + horizon) * to.ozone / up.ozone});
    }
  }
}

AirColumns::Level AirColumns::level(double height_m) const {
  const TablePlace h = table_place(height_m / height_step_m, heights);
  const AirColumn &below = log_up_[h.node], &above = log_up_[h.node + 1];
  return {height_m,
          h.node,
          h.part,
          {std::exp(std::lerp(below.air, above.air, h.part)),
           std::exp(std::lerp(below.ozone, above.ozone, h.part))}};
}

AirColumn AirColumns::upwards(const Level& level, double cos_zenith) const {
  const double over = 1.0 / (cos_zenith + horizon);
  const TablePlace a = table_place(cos_zenith * over * (1.0 + horizon) * (angles - 1), angles);
  const AirColumn* below = &stretched_[level.node * angles + a.node];
  const AirColumn* above = below + angles;
  const auto stretch = [&](double AirColumn::*part) {
    return over * std::lerp(std::lerp(below[0].*part, below[1].*part, a.part),
                            std::lerp(above[0].*part, above[1].*part, a.part), level.part);
  };
  return {level.up.air * stretch(&AirColumn::air), level.up.ozone * stretch(&AirColumn::ozone)};
}

AirColumn AirColumns::downwards(const Level& from, double cos_zenith, double lowest_m) const {
  if (lowest_m >= top_m) return {};
  const AirColumn half = upwards(level(lowest_m), 0.0), behind = upwards(from, -cos_zenith);
  return {std::max(0.0, 2.0 * half.air - behind.air),
          std::max(0.0, 2.0 * half.ozone - behind.ozone)};
}

ScatteredSunlight::ScatteredSunlight(const Band& band) {
  constexpr int wavelengths = 32;
  std::array<double, wavelengths> depth, absorbs, log_weight;
  const double whole = sunlight_photons_per_s_m2(sun_v_mag, band);
  double sum = 0.0;
  for (int i = 0; i < wavelengths; ++i) {
    const double at_m = std::lerp(band.low_m(), band.high_m(), (i + 0.5) / wavelengths);
    depth[i] = rayleigh_depth(at_m);
    absorbs[i] = ozone_absorption(at_m);
    const double light =
        band.response.at_or_zero(at_m) * sunlight_spectrum().irradiance.at_or_end(at_m) * at_m;
    sum += light;
    log_weight[i] = light > 0.0 ? std::log(light * depth[i]) : darkest;
  }
  const double scale = std::log(whole / (sum * 4.0 * pi * AirColumns::standard().column_m()));
  for (std::size_t i = 0; i < airs; ++i)
    for (std::size_t k = 0; k < ozones; ++k) {
      const double x = double(i) / (airs - 1), y = double(k) / (ozones - 1);
      const double air = max_air * x * x, ozone = max_ozone * y * y;
      std::array<double, wavelengths> log_light;
      for (int w = 0; w < wavelengths; ++w)
        log_light[w] = log_weight[w] - depth[w] * air - absorbs[w] * ozone;
      const double most = *std::ranges::max_element(log_light);
      double light = 0.0;
      for (const double log : log_light) light += std::exp(log - most);
      log_light_.push_back(scale + most + std::log(light));
    }
}

double ScatteredSunlight::behind(const AirColumn& column) const {
  if (!(column.air < max_air) || !(column.ozone < max_ozone)) return 0.0;
  // Linear in the columns themselves, as their logarithms nearly are.
  const auto of_root = [](double value, double most, std::size_t nodes) {
    TablePlace at = table_place(std::sqrt(value / most) * double(nodes - 1), nodes);
    const double step = 1.0 / double(nodes - 1), from = double(at.node) * step;
    at.part = (value / most - from * from) / (step * (2.0 * from + step));
    return at;
  };
  const TablePlace a = of_root(column.air, max_air, airs);
  const TablePlace o = of_root(column.ozone, max_ozone, ozones);
  const double* at = &log_light_[a.node * ozones + o.node];
  const double log = std::lerp(std::lerp(at[0], at[1], o.part),
                               std::lerp(at[ozones], at[ozones + 1], o.part), a.part);
  return log > darkest ? std::exp(log) : 0.0;
}

}  // namespace dmise
