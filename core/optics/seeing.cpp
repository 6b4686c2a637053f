#include "core/optics/seeing.h"

#include <cmath>

namespace dmise {

double SensorSeeing::r0_at_m(double wavelength_m) const {
  return r0_m * std::pow(wavelength_m / 0.5e-6, 1.2);
}

double SensorSeeing::tau0_s(double wavelength_m) const {
  return wind_m_per_s > 0.0 ? r0_at_m(wavelength_m) / wind_m_per_s
                            : std::numeric_limits<double>::infinity();
}

}  // namespace dmise
