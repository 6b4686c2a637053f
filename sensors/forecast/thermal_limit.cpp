#include "sensors/forecast/thermal_limit.h"

#include <cmath>

#include "core/base/units.h"
#include "core/detection/pixels/components.h"
#include "core/photometry/magnitude.h"
#include "core/photometry/planck.h"
#include "sensors/scene/throughput.h"

namespace dmise {

std::optional<ThermalLimit> thermal_limit(const View& view, const PixelBackground& background,
                                          double full_e, double sigma_px) {
  const Band& band = view.sensor().camera.band;
  if (!is_thermal(band) || view.shutter_closed() || !(background.electrons > 0.0))
    return std::nullopt;
  const double exposure_s = view.times().seconds();
  ThermalLimit limit{.background_e_per_s = background.electrons / exposure_s};
  limit.fills_in_s = full_e / limit.background_e_per_s;
  limit.nefd_photons_per_s_m2 = background.noise_e / std::sqrt(kernel_square_sum(sigma_px)) /
                                (Throughput(view).electrons_per_photon_m2() * exposure_s);
  limit.nefd_w_per_m2 =
      limit.nefd_photons_per_s_m2 * planck_j_s * speed_of_light_m_per_s / band.centre_m;
  const double of_ab_zero = limit.nefd_photons_per_s_m2 / ab_zero_point_photons_per_s_m2(band);
  constexpr double ab_zero_jy = 3631.0;
  limit.nefd_jy = ab_zero_jy * of_ab_zero;
  limit.nefd_ab_mag = magnitude_of_light(of_ab_zero);
  return limit;
}

}  // namespace dmise
