#include "core/forces/forces.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/error.h"
#include "core/base/numeric/table_place.h"
#include "core/forces/acceleration.h"
#include "core/forces/cubic.h"
#include "core/frames/earth_orientation.h"
#include "core/sky/places/sun_moon.h"

namespace dmise {

namespace {

// Height [km] and density [kg/m^3] of Vallado, Fundamentals of Astrodynamics and Applications,
// table 8-4 (after Wertz 1978: CIRA-72 and US Standard Atmosphere 1976).
struct AirRow {
  double height_km, density;
};
constexpr std::array<AirRow, 28> air_rows{
    {{0, 1.225},       {25, 3.899e-2},   {30, 1.774e-2},   {40, 3.972e-3},   {50, 1.057e-3},
     {60, 3.206e-4},   {70, 8.770e-5},   {80, 1.905e-5},   {90, 3.396e-6},   {100, 5.297e-7},
     {110, 9.661e-8},  {120, 2.438e-8},  {130, 8.484e-9},  {140, 3.845e-9},  {150, 2.070e-9},
     {180, 5.464e-10}, {200, 2.789e-10}, {250, 7.248e-11}, {300, 2.418e-11}, {350, 9.518e-12},
     {400, 3.725e-12}, {450, 1.585e-12}, {500, 6.967e-13}, {600, 1.454e-13}, {700, 3.614e-14},
     {800, 1.170e-14}, {900, 5.245e-15}, {1000, 3.019e-15}}};
constexpr double last_scale_m = 268e3;  // above the last row, of the same table
constexpr double air_end_m = 5000e3;    // where density is below 1e-21 kg/m^3

const std::array<AirLayer, air_rows.size()>& air_layers() {
  static const auto layers = [] {
    std::array<AirLayer, air_rows.size()> out;
    for (std::size_t i = 0; i < out.size(); ++i) {
      const AirRow& row = air_rows[i];
      out[i] = {row.height_km * km, row.density, last_scale_m};
      if (i + 1 < out.size())
        out[i].scale_m = (air_rows[i + 1].height_km - row.height_km) * km /
                         std::log(row.density / air_rows[i + 1].density);
    }
    return out;
  }();
  return layers;
}

void check(const ForceSettings& settings) {
  if (settings.zonals != 0 && (settings.zonals < 2 || settings.zonals > 4))
    throw Error("zonals: must be 0, 2, 3 or 4, got " + std::to_string(settings.zonals));
}

}  // namespace

AirLayer air_layer(double height_m) {
  if (!(height_m < air_end_m)) return {};
  const auto& layers = air_layers();
  if (height_m <= 0) return {height_m, layers.front().density_kg_per_m3, layers.front().scale_m};
  const auto above =
      std::upper_bound(layers.begin(), layers.end(), height_m,
                       [](double height, const AirLayer& layer) { return height < layer.base_m; });
  return *std::prev(above);
}

ForceModel::ForceModel(const ForceSettings& settings) : settings_(settings) {
  check(settings_);
  settings_.sun_moon = settings_.radiation = false;
}

ForceModel::ForceModel(const Clock& clock, SimTime reference, const ForceSettings& settings)
    : settings_(settings), first_(reference - sim_seconds(reach_s)) {
  check(settings_);
  const int count = int(2 * reach_s / node_s) + 1;
  nodes_.reserve(std::size_t(count));
  for (int i = 0; i < count; ++i) {
    const SimTime time = first_ + sim_seconds(i * node_s);
    Node node;
    if (settings_.zonals || settings_.drag)
      node.pole = earth_orientation(clock, time, Nutation::iau2000b).cirs_from_gcrs.inverse() *
                  Vec<Cirs>{0, 0, 1};
    if (settings_.radiation || settings_.sun_moon) {
      const SimTime half = sim_seconds(1800);
      node.sun_m = sun_by_almanac_m(clock.tt(time));
      node.sun_m_per_s =
          (sun_by_almanac_m(clock.tt(time + half)) - sun_by_almanac_m(clock.tt(time - half))) /
          3600.0;
    }
    if (settings_.sun_moon) {
      node.moon_m = moon_m(clock.tt(time));
      node.moon_m_per_s = moon_velocity_m_per_s(clock.tt(time));
    }
    nodes_.push_back(node);
  }
}

ForceInputs ForceModel::surroundings(SimTime time) const {
  if (nodes_.empty()) return {};
  const auto [i, u] = table_place((time - first_).seconds() / node_s, nodes_.size());
  const Node &a = nodes_[i], &b = nodes_[i + 1];
  ForceInputs out;
  out.pole = a.pole * (1 - u) + b.pole * u;  // shorter than 1 by less than 1e-14
  if (settings_.radiation || settings_.sun_moon)
    out.sun_m = cubic_between(a.sun_m, a.sun_m_per_s, b.sun_m, b.sun_m_per_s, node_s, u);
  if (settings_.sun_moon)
    out.moon_m = cubic_between(a.moon_m, a.moon_m_per_s, b.moon_m, b.moon_m_per_s, node_s, u);
  return out;
}

}  // namespace dmise
