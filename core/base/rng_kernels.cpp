#include "core/base/rng_kernels.h"

#include "core/base/random_lanes.h"

namespace dmise::DMISE_SIMD {

void rng_groups(const RngKey& key, std::uint32_t first, std::size_t count, std::uint32_t draw,
                std::uint32_t* out) {
  for (std::size_t i = 0; i < count; i += rng_group) {
    const std::uint32_t block = (first + std::uint32_t(i)) / 4;
    for (int b = 0; b < 8; b += wide_lanes) {
      U64 words[2];
      philox(key, block + std::uint32_t(b), draw, words);
      store(out + i + 2 * b, words[0]);
      store(out + i + 16 + 2 * b, words[1]);
    }
  }
}

void normals_of(const std::uint32_t* words, std::size_t count, float* out) {
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) store(out + i, normal_of_words(load<U32>(words + i)));
  if (i == count) return;
  U32 last{};
  for (std::size_t j = i; j < count; ++j) last[j - i] = words[j];
  const F32 z = normal_of_words(last);
  for (std::size_t j = i; j < count; ++j) out[j] = z[j - i];
}

}  // namespace dmise::DMISE_SIMD
