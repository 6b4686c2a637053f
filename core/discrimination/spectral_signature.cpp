#include "core/discrimination/spectral_signature.h"

#include <cmath>

#include "core/base/error.h"
#include "core/photometry/magnitude.h"

namespace dmise {

double full_sunlight_e(double zero_point_mag, double exposure_s) {
  return light_of_magnitude(sun_v_mag - zero_point_mag) * exposure_s;
}

Measured reflected(const Measured& flux_e, double full_sunlight_e, double aperture_fraction) {
  const double scale = 1.0 / (full_sunlight_e * aperture_fraction);
  return {flux_e.value * scale, flux_e.sigma * scale};
}

Measured flux_ratio(const Measured& numerator, const Measured& denominator) {
  if (!(denominator.value > 0.0)) throw Error("flux ratio: no light in the denominator");
  const double ratio = numerator.value / denominator.value;
  const double spread = denominator.sigma / denominator.value;
  const double square = spread * spread;
  return {ratio * (1.0 - square + 3.0 * square * square),
          std::hypot(numerator.sigma / denominator.value, ratio * spread)};
}

}  // namespace dmise
