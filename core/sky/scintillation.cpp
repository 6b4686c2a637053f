#include "core/sky/scintillation.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/sky/airmass.h"

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

Scintillation::Scintillation(const AirExposure& exposure)
    : key_(rng_key(exposure.seed, exposure.sensor, exposure.frame, facts.name)),
      up_(exposure.up),
      sigma_at_zenith_(scintillation_sigma(exposure.aperture_m, exposure.exposure_s, 1.0,
                                           exposure.site_height_m)) {}

double Scintillation::apply(const SightLine& line) const {
  const double x = airmass(elevation_over(up_, line.apparent));
  const double sigma = std::min(1.0, sigma_at_zenith_ * x * std::sqrt(x));
  const double log_variance = std::log1p(sigma * sigma);
  const double z =
      normal_of(rng_word(key_, line.number, line.source == SightLine::Source::star ? 0 : 1));
  return std::exp(std::sqrt(log_variance) * z - 0.5 * log_variance);
}

}  // namespace dmise
