#include "core/materials/thermal.h"

namespace dmise {

double emitted_photons_per_s_m2_sr(const Material& material, const Band& band) {
  return material.thermal_emissivity * photons_of_radiance(band, [&](double wavelength_m) {
           return planck_w_per_m2_sr_m(wavelength_m, material.temperature_k);
         });
}

}  // namespace dmise
