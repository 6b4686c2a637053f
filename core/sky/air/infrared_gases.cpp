#include "core/sky/air/infrared_gases.h"

#include <cmath>
#include <iterator>

#include "core/base/units.h"

namespace dmise {
namespace {

struct InfraredGas {
  double water_lines, water_by_itself, water_in_air, mixed, power, ozone, height_km;
};
#include "core/sky/air/infrared_gas_tables.inc"

constexpr double first_cm = 400.0, step_cm = 10.0;

}  // namespace

std::vector<InfraredAir> infrared_air(const AirGases& air, double airmass) {
  const double pressure = air.pressure_hpa / 1013.25, warm = air.temperature_k / 288.15;
  const double water = air.pwv_mm * airmass;
  const double lines = std::pow(water * std::pow(pressure, 0.9) * warm * warm, 0.55);
  const double mixed = airmass * std::pow(pressure, 1.76), ozone = std::pow(airmass, 0.73);
  const double height = std::pow(pressure, 0.08);
  std::vector<InfraredAir> spectrum;
  spectrum.reserve(std::size(infrared_gases));
  for (int i = int(std::size(infrared_gases)) - 2; i >= 0; --i) {
    const InfraredGas& g = infrared_gases[i];
    const double continuum =
        (g.water_by_itself * air.pwv_mm / (warm * warm) + g.water_in_air * pressure) * water;
    spectrum.push_back(
        {.wavelength_m = 1e-2 / (first_cm + i * step_cm),
         .lower_depth = g.water_lines * lines + continuum + g.mixed * std::pow(mixed, g.power),
         .ozone_depth = g.ozone * ozone,
         .height_m = g.height_km * 1e3 * height});
  }
  return spectrum;
}

}  // namespace dmise
