#pragma once
#include <fstream>
#include <string>

#include "core/config/scenario.h"

namespace dmise {

/// A scenario of one small camera at Huntsville, without stars and objects, written to `path`.
/// `keys`: more of the camera's sensor.
inline Scenario small_observatory(const std::string& path, const std::string& keys = {}) {
  std::ofstream(path) << R"(simulation: {start: 2018-01-21T00:30:00Z, duration_s: 28800, tick_s: 10}
sensors:
  - name: eye
    site: huntsville
    camera:
      optics: {columns: 32, rows: 24, pixel_pitch_m: 1e-5, focal_length_m: 0.1, aperture_m: 0.05, psf_fwhm_px: 1.5}
      detector: {gain_e_per_dn: 2, bias_dn: 100, read_noise_e: 5, full_well_e: 50000, adc_bits: 16, dark_e_per_s: 1,
                 dark_doubling_k: 6}
      band: {name: V, centre_m: 0.55e-6, width_m: 0.1e-6}
      filters: [bessell-B, {name: wide, centre_m: 0.55e-6, width_m: 0.2e-6}]
    pointing: zenith
    exposure_s: 1
    cadence_s: 10
    mask_deg: 10
    weather: {pressure_hpa: 989, temperature_c: 13.7, humidity: 0.5}
)" << keys << "output: {png: false}\n";
  return load_scenario(path);
}

}  // namespace dmise
