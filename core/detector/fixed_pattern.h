#pragma once
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/base/rng.h"

// What is the same in every frame of a sensor: drawn from its seed and name alone (`fixed_key`).
namespace dmise {

/// Stream of a pattern that a sensor keeps: that of frame 0, which no exposure has.
RngKey fixed_key(std::uint64_t seed, std::string_view sensor, std::string_view effect);

/// Multiplies light by the pixels' responses, 1 + rms z with a normal deviate z, never below 0.
/// `first` is a multiple of rng_group.
void response_non_uniformity(double rms, const RngKey& fixed, std::uint32_t first,
                             std::span<float> light_e, SimdLevel level);

/// A pixel with more dark current than the others.
struct HotPixel {
  std::uint32_t pixel;
  float dark_e_per_s;
};

/// The hot pixels among `pixels`, by rising index: each with probability `fraction`, its dark
/// current exponentially distributed about `mean_e_per_s`.
std::vector<HotPixel> hot_pixels(double fraction, double mean_e_per_s, std::size_t pixels,
                                 const RngKey& fixed);

/// Adds the hot pixels' Poisson deviates to electrons of the pixels from `first` on.
void add_hot_pixels(std::span<const HotPixel> hot, double exposure_s, const RngKey& key,
                    std::uint32_t first, std::span<float> electrons);

}  // namespace dmise
