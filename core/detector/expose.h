#pragma once
#include "core/detector/detector.h"

namespace dmise {

/// What a detector keeps from one exposure to the next. Empty at first.
struct DetectorMemory {
  PersistenceMemory persistence;  // all by which a frame depends on the ones before it
  ElectronImage electrons;        // work area, if effects need a pixel's neighbours
};

/// What else may be asked of an exposure.
struct ExposeOptions {
  DetectorMemory* memory = nullptr;  // none: traps are empty and nothing is kept
  FlagImage* flags = nullptr;        // filled in if given (resized as needed)
  SimdLevel level = best_simd_level();
};

/// Exposes a detector to `light`, the photo-electrons expected of each pixel during the exposure
/// [e-] (quantum efficiency applied), and reads it out into `counts` (resized as needed, memory
/// kept): all of `DetectorEffects` that apply, in their order. The image runs through them piece by
/// piece, so that nothing of its size is held but light and counts (and `memory.electrons` for
/// effects that need a pixel's neighbours). An effect that is off or whose parameters leave it
/// nothing to do is left out. Each effect draws from a stream of its own: switching one leaves the
/// noise of the others as it was, and the bytes depend on neither threads nor instruction set. Adds
/// each effect's seconds to `times` (summed over threads) if given. Throws `Error` naming the pixel
/// when `light` is NaN or negative, and what an effect refuses.
SaturatedPixels expose(const ExpectedElectronImage& light, const Detector& detector,
                       const Exposure& exposure, const EffectSet& effects, Threads& threads,
                       CountImage& counts, EffectTimes* times = nullptr,
                       const ExposeOptions& options = {});

}  // namespace dmise
