#pragma once
#include <span>

#include "core/base/numeric/rng.h"

namespace dmise {

/// Words of any pixels: out[i] = rng_word(key, pixels[i], draw). Both spans have one size.
void rng_words_at(const RngKey& key, std::span<const std::uint32_t> pixels, std::uint32_t draw,
                  std::span<std::uint32_t> out, SimdLevel level = best_simd_level());

}  // namespace dmise
