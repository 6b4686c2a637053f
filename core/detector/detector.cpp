#include "core/detector/detector.h"

#include <charconv>
#include <cmath>
#include <string>

#include "core/base/error.h"

namespace dmise {
namespace {

void require(bool holds, const char* key, const char* reason, double got) {
  if (holds) return;
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, got).ptr;
  throw ConfigError(std::string("detector.") + key + ": " + reason + ", got " +
                    std::string(text, end));
}

}  // namespace

void check(const Detector& d) {
  const auto within = [](double v, double low, double high) { return v >= low && v <= high; };
  require(d.quantum_efficiency > 0.0 && d.quantum_efficiency <= 1.0, "quantum_efficiency",
          "must be in (0, 1]", d.quantum_efficiency);
  require(within(d.dark_e_per_s, 0.0, 1e9), "dark_e_per_s", "must be in 0..1e9", d.dark_e_per_s);
  require(within(d.read_noise_e, 0.0, 1e6), "read_noise_e", "must be in 0..1e6", d.read_noise_e);
  require(d.full_well_e > 0.0 && d.full_well_e <= 1e9, "full_well_e", "must be in (0, 1e9]",
          d.full_well_e);
  require(d.gain_e_per_dn > 0.0 && d.gain_e_per_dn <= 1e6, "gain_e_per_dn", "must be in (0, 1e6]",
          d.gain_e_per_dn);
  require(within(d.bias_dn, 0.0, 65535.0), "bias_dn", "must be in 0..65535", d.bias_dn);
  require(d.adc_bits >= 1 && d.adc_bits <= 16, "adc_bits", "must be 1..16", d.adc_bits);
  const auto share = [&](double v, const char* key, double most) {
    require(within(v, 0.0, most), key, "must be >= 0 and within its range", v);
  };
  share(d.prnu_rms, "prnu_rms", 0.2);
  share(d.hot_pixel_fraction, "hot_pixel_fraction", 1.0);
  share(d.hot_pixel_e_per_s, "hot_pixel_e_per_s", 1e9);
  share(d.column_noise_e, "column_noise_e", 1e6);
  share(d.nonlinearity, "nonlinearity", 0.5);
  share(d.interpixel_coupling, "interpixel_coupling", 0.2);
  share(d.persistence_fraction, "persistence_fraction", 1.0);
  share(d.persistence_s, "persistence_s", 1e9);
  share(d.cosmic_rays_per_px_s, "cosmic_rays_per_px_s", 1.0);
  share(d.cosmic_ray_e_per_px, "cosmic_ray_e_per_px", 1e9);
  require(d.cosmic_ray_depth_px > 0.0 && d.cosmic_ray_depth_px <= 100.0, "cosmic_ray_depth_px",
          "must be in (0, 100]", d.cosmic_ray_depth_px);
  require(d.reference_px >= 0 && d.reference_px <= 1000, "reference_px", "must be 0..1000",
          d.reference_px);
  require(d.persistence_fraction == 0.0 || d.persistence_s > 0.0, "persistence_s",
          "must be > 0 with persistence", d.persistence_s);
}

double dark_current_at(double temperature_k, double reference_e_per_s, double reference_k,
                       double doubling_k) {
  return reference_e_per_s * std::exp2((temperature_k - reference_k) / doubling_k);
}

}  // namespace dmise
