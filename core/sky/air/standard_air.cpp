#include "core/sky/air/standard_air.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/units.h"
#include "core/photometry/curve.h"
#include "core/sky/air/refraction.h"

namespace dmise {
namespace {

struct Layer {
  double from_m, kelvin, kelvin_per_m, pressure;  // at its lower end; geopotential height
};

/// Pressure at a height over that at the lower end of a layer.
double pressure_ratio(const Layer& layer, double geopotential_m) {
  constexpr double kelvin_per_m = 0.0341632;  // gravity over the gas constant
  const double rises_m = geopotential_m - layer.from_m;
  if (layer.kelvin_per_m == 0.0) return std::exp(-kelvin_per_m * rises_m / layer.kelvin);
  const double kelvin = std::max(1.0, layer.kelvin + layer.kelvin_per_m * rises_m);
  return std::pow(kelvin / layer.kelvin, -kelvin_per_m / layer.kelvin_per_m);
}

}  // namespace

double relative_density(double height_m) {
  static const auto layers = [] {
    std::array<Layer, 7> known{{{0, 288.15, -6.5e-3, 1.0},
                                {11e3, 216.65, 0.0, 0.0},
                                {20e3, 216.65, 1e-3, 0.0},
                                {32e3, 228.65, 2.8e-3, 0.0},
                                {47e3, 270.65, 0.0, 0.0},
                                {51e3, 270.65, -2.8e-3, 0.0},
                                {71e3, 214.65, -2e-3, 0.0}}};
    for (std::size_t i = 1; i < known.size(); ++i)
      known[i].pressure = known[i - 1].pressure * pressure_ratio(known[i - 1], known[i].from_m);
    return known;
  }();
  const double geopotential_m = 6356766.0 * height_m / (6356766.0 + height_m);
  std::size_t i = layers.size() - 1;
  while (i > 0 && geopotential_m < layers[i].from_m) --i;
  const double kelvin = std::max(
      150.0, layers[i].kelvin + layers[i].kelvin_per_m * (geopotential_m - layers[i].from_m));
  return layers[i].pressure * pressure_ratio(layers[i], geopotential_m) * 288.15 / kelvin;
}

double refractivity_at_sea(double wavelength_m) {
  return 1e-6 * dry_air_refractivity(wavelength_m) * 1013.25 / 288.15;
}

double ozone_density(double height_m) {
  constexpr double middle_m = 22e3, width_m = 5e3;
  const double t = (height_m - middle_m) / width_m;
  return ozone_column_atm_cm * std::exp(-0.5 * t * t) / (width_m * std::sqrt(2 * pi));
}

double ozone_absorption(double wavelength_m) {
  static const Curve curve{
      {300 * nm, 305 * nm, 310 * nm, 315 * nm, 320 * nm, 325 * nm, 330 * nm, 335 * nm,
       340 * nm, 350 * nm, 440 * nm, 450 * nm, 480 * nm, 500 * nm, 530 * nm, 550 * nm,
       570 * nm, 593 * nm, 610 * nm, 630 * nm, 656 * nm, 690 * nm, 740 * nm, 780 * nm},
      {10.0,  4.8,  2.7,   1.35,  0.8,  0.38,  0.16, 0.075, 0.04,  0.007, 0.0,  0.003,
       0.014, 0.03, 0.063, 0.085, 0.12, 0.119, 0.12, 0.09,  0.065, 0.028, 0.01, 0.0}};
  return curve.at_or_end(wavelength_m);
}

double rayleigh_depth(double wavelength_m) {
  const double s = um * um / (wavelength_m * wavelength_m);
  return 0.008569 * s * s * (1 + 0.0113 * s + 0.00013 * s * s);
}

}  // namespace dmise
