#pragma once
#include "core/detector/detector.h"

namespace dmise {

/// State that a detector keeps between exposures. Initially empty.
struct DetectorMemory {
  PersistenceMemory persistence;  // the only dependence of a frame on earlier ones
  ElectronImage electrons;        // work area, if effects need a pixel's neighbours
};

/// Optional inputs and outputs of an exposure.
struct ExposeOptions {
  DetectorMemory* memory = nullptr;  // null: traps are empty and nothing is kept
  FlagImage* flags = nullptr;        // filled if given (resized as needed)
  SimdLevel level = best_simd_level();
};

/// Exposes a detector to `light`, the expected photo-electrons of each pixel during the exposure
/// [e-] (quantum efficiency applied; above 4e11, beyond any well, it is 4e11), and reads it out
/// into `counts` (resized as needed, memory kept): applies all of `DetectorEffects`, in their
/// order. The image is processed piece by piece, so that only light and counts (and
/// `memory.electrons` for effects that need a pixel's neighbours) are held in full size. Effects
/// that are off or have neutral parameters are skipped. Each effect has its own random stream:
/// switching one does not change the noise of the others, and the bytes depend on neither threads
/// nor instruction set. Adds each effect's seconds to `times` (summed over threads) if given.
/// Throws `Error` naming the pixel if `light` is negative, infinite or NaN, and for parameters that
/// an effect refuses.
SaturatedPixels expose(const ExpectedElectronImage& light, const Detector& detector,
                       const Exposure& exposure, const EffectSet& effects, Threads& threads,
                       CountImage& counts, EffectTimes* times = nullptr,
                       const ExposeOptions& options = {});

}  // namespace dmise
