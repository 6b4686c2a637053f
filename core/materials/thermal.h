#pragma once
#include "core/materials/material.h"

// Thermal emission of a surface: grey and diffuse, Planck's law.
namespace dmise {

/// Spectral radiance of a black body [W/m2/sr/m]; 0 at 0 K.
double planck_w_per_m2_sr_m(double wavelength_m, double temperature_k);

/// Photons/s/m2/sr that a material emits in a band, weighted by its response; the same in every
/// direction. Midpoint sum with a relative error below 1e-3 for bands of up to half their
/// wavelength.
double emitted_photons_per_s_m2_sr(const Material& material, const Band& band);

}  // namespace dmise
