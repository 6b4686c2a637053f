#pragma once
#include "core/detector/expose.h"

namespace dmise {

/// Standard deviation [e-] from frame to frame that `expose` gives each pixel: photons, dark
/// current, hot pixels, columns, reading and rounding, of the effects that are on. Not in it: what
/// is the same in every frame (prnu), cosmic rays, what clipping takes away, charge of persistence,
/// and the mixing by interpixel coupling. Non-linearity acts by its slope.
ElectronImage expected_noise(const ExpectedElectronImage& light, const Detector& detector,
                             const Exposure& exposure, const EffectSet& effects, Threads& threads);

}  // namespace dmise
