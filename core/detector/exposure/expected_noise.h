#pragma once
#include "core/detector/exposure/expose.h"

namespace dmise {

/// Standard deviation [e-] between frames that `expose` gives each pixel: photons, dark current,
/// hot pixels, columns, read noise and rounding, of the effects that are on. Not included: fixed
/// patterns (prnu), cosmic rays, clipping, persistence, and mixing by interpixel coupling.
/// Nonlinearity acts by its slope.
ElectronImage expected_noise(const ExpectedElectronImage& light, const Detector& detector,
                             const Exposure& exposure, const EffectSet& effects, Threads& threads);

}  // namespace dmise
