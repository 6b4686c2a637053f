#pragma once
#include "core/materials/material.h"
#include "core/photometry/planck.h"

// Thermal emission of a surface: grey and diffuse, Planck's law.
namespace dmise {

/// Photons/s/m2/sr that a material emits in a band, weighted by its response; the same in every
/// direction.
double emitted_photons_per_s_m2_sr(const Material& material, const Band& band);

}  // namespace dmise
