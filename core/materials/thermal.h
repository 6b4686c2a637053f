#pragma once
#include "core/materials/material.h"

// Thermal emission of a surface: grey and diffuse, Planck's law.
namespace dmise {

/// Spectral radiance of a black body [W/m2/sr/m]; 0 at 0 K.
double planck_w_per_m2_sr_m(double wavelength_m, double temperature_k);

/// Radiance of a black body from `low_m` to `high_m` [W/m2/sr], relative error below 1e-9. From 0
/// to infinity: sigma T^4 / pi. Source: the series of Chang & Rhee 1984, Int. Comm. Heat Mass
/// Transfer 11, 451.
double black_body_radiance_w_per_m2_sr(double temperature_k, double low_m, double high_m);

/// The same in photons [1/s/m2/sr] within a band, weighted by its response; midpoint sum with a
/// relative error below 1e-3 for bands of up to half their wavelength.
double black_body_radiance_photons_per_s_m2_sr(double temperature_k, const Band& band);

/// Photons/s/m2/sr that a material emits in a band, the same in every direction.
double emitted_photons_per_s_m2_sr(const Material& material, const Band& band);

}  // namespace dmise
