#pragma once
#include <cstdint>
#include <string>

#include "core/base/image.h"
#include "core/base/parallel.h"
#include "core/base/simd_level.h"
#include "core/detector/detector.h"
#include "core/detector/persistence.h"
#include "core/detector/pixel_flags.h"
#include "core/effects/effects.h"

namespace dmise {

/// What names an exposure's random numbers, and its length.
struct Exposure {
  std::uint64_t seed = 0;
  std::string sensor;  // its name
  std::uint32_t frame = 0;
  double exposure_s = 0.0;  // >= 0
  double idle_s = 0.0;      // since the end of the exposure before, for persistence; >= 0
};

/// What a detector keeps from one exposure to the next. Empty at first.
struct DetectorMemory {
  PersistenceMemory persistence;  // all by which a frame depends on the ones before it
  ElectronImage electrons;        // work area, if effects need a pixel's neighbours
};

/// Pixels that reached a limit.
struct SaturatedPixels {
  std::size_t full_well = 0;
  std::size_t adc = 0;  // at the highest count that the ADC or the 16-bit image holds

  bool operator==(const SaturatedPixels&) const = default;
};

/// What else may be asked of an exposure.
struct ExposeOptions {
  DetectorMemory* memory = nullptr;  // none: traps are empty and nothing is kept
  FlagImage* flags = nullptr;        // filled in if given (resized as needed)
  SimdLevel level = best_simd_level();
};

/// Most cosmic ray hits in one exposure: more are refused.
inline constexpr double most_cosmic_hits = 1e7;

/// Exposes a detector to `light`, the photo-electrons expected of each pixel during the exposure
/// [e-] (quantum efficiency applied), and reads it out into `counts` (resized as needed, memory
/// kept):
///   fresh     = photon_noise(light x response (prnu)) + dark_current + hot_pixels + cosmic_rays,
///               nothing in reference_pixels
///   electrons = fresh + a Poisson draw of what the traps release (persistence), up to full_well
///               (or blooming); the traps take their share of `fresh`
///   signal    = electrons with interpixel_coupling and nonlinearity
///   counts    = quantisation(signal + column_noise + read_noise)
/// The image runs through all effects piece by piece, so that nothing of its size is held but light
/// and counts (and `memory.electrons` for blooming and interpixel coupling). An effect that is off
/// or whose figure is 0 is left out: without photon noise the expected electrons go on, without
/// quantisation counts are whole electrons without bias, limited by the image's 16 bits alone. Each
/// effect draws from a stream of its own: switching one leaves the noise of the others as it was,
/// and the bytes depend on neither threads nor instruction set. Adds each effect's seconds to
/// `times` (summed over threads) if given. Throws `Error` naming the pixel when `light` is NaN or
/// negative, and for more than `most_cosmic_hits` expected hits.
SaturatedPixels expose(const RateImage& light, const Detector& detector, const Exposure& exposure,
                       const EffectSet& effects, Threads& threads, CountImage& counts,
                       EffectTimes* times = nullptr, const ExposeOptions& options = {});

}  // namespace dmise
