#pragma once
#include "core/detector/detector.h"

namespace dmise {

/// A detector's parameters by name.
struct DetectorNumbers {
  double quantum_efficiency = 1.0;
  double dark_e_per_s = 0.0;
  double dark_reference_c = 0.0;
  double temperature_c = 0.0;
  double dark_doubling_k = 0.0;
  double read_noise_e = 0.0;
  double full_well_e = 1e5;
  double gain_e_per_dn = 1.0;
  double bias_dn = 0.0;
  int adc_bits = 16;
  double prnu_rms = 0.0;
  double hot_pixel_fraction = 0.0;
  double hot_pixel_e_per_s = 0.0;
  double column_noise_e = 0.0;
  double nonlinearity = 0.0;
  double interpixel_coupling = 0.0;
  bool blooming = false;
  double persistence_fraction = 0.0;
  double persistence_s = 0.0;
  double cosmic_rays_per_px_s = 0.0;
  double cosmic_ray_e_per_px = 1000.0;
  double cosmic_ray_depth_px = 1.0;
  int reference_px = 0;
};

constexpr Detector detector_of(const DetectorNumbers& n) {
  Detector d;
  d.quantum_efficiency = n.quantum_efficiency;
  d.dark_e_per_s = n.dark_e_per_s;
  d.dark_reference_c = n.dark_reference_c;
  d.temperature_c = n.temperature_c;
  d.dark_doubling_k = n.dark_doubling_k;
  d.read_noise_e = n.read_noise_e;
  d.full_well_e = n.full_well_e;
  d.gain_e_per_dn = n.gain_e_per_dn;
  d.bias_dn = n.bias_dn;
  d.adc_bits = n.adc_bits;
  d.prnu_rms = n.prnu_rms;
  d.hot_pixel_fraction = n.hot_pixel_fraction;
  d.hot_pixel_e_per_s = n.hot_pixel_e_per_s;
  d.column_noise_e = n.column_noise_e;
  d.nonlinearity = n.nonlinearity;
  d.interpixel_coupling = n.interpixel_coupling;
  d.blooming = n.blooming;
  d.persistence_fraction = n.persistence_fraction;
  d.persistence_s = n.persistence_s;
  d.cosmic_rays_per_px_s = n.cosmic_rays_per_px_s;
  d.cosmic_ray_e_per_px = n.cosmic_ray_e_per_px;
  d.cosmic_ray_depth_px = n.cosmic_ray_depth_px;
  d.reference_px = n.reference_px;
  return d;
}

inline bool applies(const Detector& detector, const EffectFacts& effect) {
  bool found = false;
  DetectorEffects::for_each([&]<class Effect>() {
    if (Effect::facts.name == effect.name)
      found = static_cast<const Effect&>(detector).applies(detector);
  });
  return found;
}

}  // namespace dmise
