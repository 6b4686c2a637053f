#include "core/sky/scintillation.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"

namespace dmise {

double scintillation_sigma(double aperture_m, double exposure_s, double airmass,
                           double site_height_m) {
  if (!(aperture_m > 0)) throw Error("scintillation: aperture must be > 0");
  if (!(exposure_s >= 0)) throw Error("scintillation: exposure must be >= 0");
  constexpr double scale_height_m = 8000.0, pattern_m_per_s = 20.0;
  const double exposure = std::max(exposure_s, aperture_m / pattern_m_per_s);
  return std::sqrt(10e-6 * std::pow(aperture_m, -4.0 / 3.0) / exposure * airmass * airmass *
                   airmass * std::exp(-2.0 * site_height_m / scale_height_m));
}

}  // namespace dmise
