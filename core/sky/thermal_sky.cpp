#include "core/sky/thermal_sky.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/effects/plan_facts.h"
#include "core/photometry/planck.h"
#include "core/sky/air/airmass.h"
#include "core/sky/air/colour_airmass.h"
#include "core/sky/air/infrared_gases.h"
#include "core/sky/air/kept_tables.h"

namespace dmise {
namespace {

constexpr double lapse_k_per_m = 6.5e-3, near_infrared_height_m = 1500.0;
constexpr ColourAirmassNodes nodes{2, 65};

/// Temperature of the ozone's light: 225 K over 600 hPa, and more over a lower site, as there is
/// ozone in the warm air, too.
double ozone_k(const AirGases& gases) {
  return 225.0 + 22.0 * (gases.pressure_hpa / 1013.25 - 0.593);
}

/// Radiance over wavelength [W/m2/sr/m].
Curve radiance(const AirGases& gases, double airmass) {
  Curve curve;
  const Curve near = gas_transmission(gases, airmass);
  for (std::size_t i = 0; i < near.value.size() && near.wavelength_m[i] < infrared_from_m; ++i) {
    const double kelvin = gases.temperature_k - lapse_k_per_m * near_infrared_height_m;
    curve.add(near.wavelength_m[i],
              (1.0 - near.value[i]) * planck_w_per_m2_sr_m(near.wavelength_m[i], kelvin));
  }
  for (const InfraredAir& air : infrared_air(gases, airmass)) {
    const double kelvin = gases.temperature_k - lapse_k_per_m * air.height_m;
    const double ozone = std::exp(-air.lower_depth) * -std::expm1(-air.ozone_depth);
    curve.add(air.wavelength_m,
              -std::expm1(-air.lower_depth) * planck_w_per_m2_sr_m(air.wavelength_m, kelvin) +
                  ozone * planck_w_per_m2_sr_m(air.wavelength_m, ozone_k(gases)));
  }
  return curve;
}

}  // namespace

ErrorBound ThermalSky::error(int, const PlanFacts& f) {
  return f.without_part(SkyPart::thermal_sky);
}

double ThermalSky::cost_s(int level, const PlanFacts& f) { return level * 20e-9 * f.sky_looks(); }

AirRadiance::AirRadiance(const Band& band, const AirGases& gases) {
  struct Key {
    Band band;
    AirGases gases;
    bool operator==(const Key&) const = default;
  };
  static KeptTables<Key, std::vector<double>> tables;
  by_airmass_ = tables.of({band, gases}, [&] {
    const int steps = std::max(256, int(std::ceil((band.high_m() - band.low_m()) / (5 * nm))));
    std::vector<double> table;
    for (int a = 0; a < nodes.airmasses; ++a) {
      const Curve curve = radiance(gases, nodes.airmass(a));
      table.push_back(photons_of_radiance(
          band, [&](double wavelength_m) { return curve.at_or_zero(wavelength_m); }, steps));
    }
    return table;
  });
}

double AirRadiance::photons_per_s_m2_sr(double sin_altitude) const {
  const double x = airmass(std::asin(std::clamp(sin_altitude, 0.0, 1.0)));
  return nodes.between(nodes.place(x, 0.0),
                       [&](int, int node) { return (*by_airmass_)[std::size_t(node)]; });
}

}  // namespace dmise
