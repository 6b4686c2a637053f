#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/image.h"
#include "core/base/parallel.h"
#include "core/base/simd_level.h"
#include "core/detector/detector.h"
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

/// What a detector keeps from one exposure to the next: trapped charge, and memory to use again.
/// Empty at first. Only persistence makes a frame depend on the ones before it.
struct DetectorMemory {
  std::vector<float> trapped_e;  // rows x columns, if there is persistence
  ElectronImage electrons;       // work area, if effects need a pixel's neighbours
};

/// Pixels that reached a limit.
struct SaturatedPixels {
  std::size_t full_well = 0;
  std::size_t adc = 0;  // at the highest count that the ADC or the 16-bit image holds

  bool operator==(const SaturatedPixels&) const = default;
};

/// Exposes a detector to `light`, the photo-electrons expected of each pixel during the exposure
/// [e-] (quantum efficiency applied), and reads it out into `counts` (resized as needed, memory
/// kept):
///   light     = light x response (prnu) + trapped charge (persistence)
///   electrons = photon_noise(light) + dark_current + hot pixels + cosmic rays, none in reference
///               pixels, up to full_well (or blooming)
///   signal    = electrons with interpixel coupling and nonlinearity
///   counts    = quantisation(signal + column noise + read_noise)
/// The image runs through all effects piece by piece, so that nothing of its size is held but light
/// and counts (and `memory.electrons` for blooming and interpixel coupling). An effect that is off
/// is left out: without photon noise the expected electrons go on, without quantisation counts are
/// whole electrons without bias, limited by the image's 16 bits alone. Each effect draws from a
/// stream of its own: switching one leaves the noise of the others as it was, and the bytes depend
/// on neither threads nor instruction set. Adds each effect's seconds to `times` (summed over
/// threads) if given. Throws `Error` naming the pixel when `light` is NaN or negative.
SaturatedPixels expose(const RateImage& light, const Detector& detector, const Exposure& exposure,
                       const EffectSet& effects, Threads& threads, CountImage& counts,
                       EffectTimes* times = nullptr, SimdLevel level = best_simd_level(),
                       DetectorMemory* memory = nullptr);

}  // namespace dmise
