#include "core/sky/air/gas_absorption.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/effects/plan_facts.h"
#include "core/photometry/magnitude.h"
#include "core/photometry/star_spectrum.h"
#include "core/sky/air/airmass.h"
#include "core/sky/air/colour_airmass.h"
#include "core/sky/air/infrared_gases.h"
#include "core/sky/air/kept_tables.h"

namespace dmise {
namespace {

struct Gas {
  double wavelength_nm, water, mixed;
};
#include "core/sky/air/gas_tables.inc"

constexpr int colours = 25, airmasses = 33;  // every 0.1 of B-V
constexpr ColourAirmassNodes nodes{colours, airmasses};

void check(double value, double most, const char* name) {
  if (!(value >= 0.0 && value <= most))
    throw Error(std::string(name) + ": must be in [0, " + std::to_string(most) + "], got " +
                std::to_string(value));
}

}  // namespace

ErrorBound GasAbsorption::error(int, const PlanFacts& f) { return f.dimmed_by(1.1 * f.gas_mag); }

double GasAbsorption::cost_s(int level, const PlanFacts& f) { return level * 82e-9 * f.stars; }

double usual_pwv_mm(double height_m) {
  constexpr double scale_height_m = 2000.0;
  return 14.2 * std::exp(-std::max(0.0, height_m) / scale_height_m);
}

Curve gas_transmission(const AirGases& air, double airmass) {
  check(air.pwv_mm, 100.0, "pwv_mm");
  check(air.pressure_hpa, 1100.0, "pressure_hpa");
  const double water_cm = 0.1 * air.pwv_mm * airmass;
  const double mixed_airmass = airmass * air.pressure_hpa / 1013.25;
  Curve curve;
  for (const Gas& gas : gases) {
    if (gas.wavelength_nm * nm > infrared_from_m) break;
    const double w = gas.water * water_cm, u = gas.mixed * mixed_airmass;
    curve.add(gas.wavelength_nm * nm, std::exp(-0.2385 * w / std::pow(1.0 + 20.07 * w, 0.45) -
                                               1.41 * u / std::pow(1.0 + 118.3 * u, 0.45)));
  }
  for (const InfraredAir& at : infrared_air(air, airmass))
    curve.add(at.wavelength_m, std::exp(-at.lower_depth - at.ozone_depth));
  return curve;
}

Curve with_haze_beyond(const Curve& extinction) {
  Curve curve = extinction;
  if (curve.empty()) return curve;
  const double last_m = curve.wavelength_m.back(), last = curve.value.back();
  for (double x = last_m + 100 * nm; x < 4.05 * um; x += 100 * nm) {
    curve.add(x, last * std::pow(x / last_m, -1.3));
  }
  return curve;
}

BandGases::BandGases(const Band& band, const Curve& extinction, const AirGases& air) {
  const double width_m = band.high_m() - band.low_m();
  const int steps = std::max(128, int(std::ceil(width_m / (2 * nm))));
  const double step_m = width_m / steps;
  std::vector<double> x_m(steps), k_mag(steps), response(steps), photons(steps);
  for (int s = 0; s < steps; ++s) {
    x_m[s] = band.low_m() + (s + 0.5) * step_m;
    k_mag[s] = extinction.at_or_end(x_m[s]);
    response[s] = band.response.at_or_zero(x_m[s]);
  }
  const double min_k = *std::min_element(k_mag.begin(), k_mag.end());
  std::vector<double> without(std::size_t(steps) * airmasses), with(without.size());
  for (int a = 0; a < airmasses; ++a) {
    const Curve transmission = gas_transmission(air, nodes.airmass(a));
    for (int s = 0; s < steps; ++s) {
      const auto at = std::size_t(a * steps + s);
      without[at] = light_of_magnitude((k_mag[s] - min_k) * nodes.airmass(a));
      with[at] = without[at] * transmission.at_or_end(x_m[s]);
    }
  }
  for (int c = 0; c < colours; ++c) {
    const StarSpectrum star = star_spectrum(nodes.bv(c));
    for (int s = 0; s < steps; ++s) photons[s] = response[s] * star.photons_at(x_m[s]);
    for (int a = 0; a < airmasses; ++a) {
      double through = 0.0, above = 0.0;
      for (int s = 0; s < steps; ++s) {
        through += photons[s] * with[std::size_t(a * steps + s)];
        above += photons[s] * without[std::size_t(a * steps + s)];
      }
      log_of_transmission_.push_back(std::log(std::max(through / above, 1e-30)));
    }
  }
}

double BandGases::of_star(double airmass, double bv) const {
  return std::exp(nodes.between(nodes.place(airmass, bv), [&](int colour, int node) {
    return log_of_transmission_[std::size_t(colour * airmasses + node)];
  }));
}

GasAbsorption::GasAbsorption(const AirExposure& exposure) : up_(exposure.up) {
  struct Key {
    Band band;
    Curve extinction;
    AirGases gases;
    bool operator==(const Key&) const = default;
  };
  static KeptTables<Key, BandGases> tables;
  const AirGases gases = exposure.gases.value_or(AirGases{.pwv_mm = 0.0, .pressure_hpa = 0.0});
  table_ = tables.of({exposure.band, exposure.extinction_mag_per_airmass, gases}, [&] {
    return BandGases(exposure.band, exposure.extinction_mag_per_airmass, gases);
  });
}

double GasAbsorption::apply(const SightLine& line) const {
  return table_->of_star(airmass_along(up_, line), line.bv);
}

double GasAbsorption::sunlight_mag(double airmass) const {
  return magnitude_of_light(table_->of_star(airmass, sun_bv));
}

}  // namespace dmise
