#include "core/base/numeric/rng_kernels.h"

#include "core/base/numeric/random_lanes.h"

namespace dmise::DMISE_SIMD {

void rng_groups(const RngKey& key, std::uint32_t first, std::size_t count, std::uint32_t draw,
                std::uint32_t* out) {
  constexpr int most = 4 * rng_group;
  std::size_t i = 0;
  for (; i + most <= count; i += most) words_of<most>(key, first + std::uint32_t(i), draw, out + i);
  for (; i < count; i += rng_group)
    words_of<rng_group>(key, first + std::uint32_t(i), draw, out + i);
}

void rng_words_at(const RngKey& key, const std::uint32_t* pixels, std::size_t count,
                  std::uint32_t draw, std::uint32_t* out) {
  std::size_t i = 0;
  for (; i + pixels_abreast <= count; i += pixels_abreast) words_at(key, pixels + i, draw, out + i);
  if (i == count) return;
  std::uint32_t last[pixels_abreast] = {}, words[pixels_abreast];
  for (std::size_t j = i; j < count; ++j) last[j - i] = pixels[j];
  words_at(key, last, draw, words);
  for (std::size_t j = i; j < count; ++j) out[j] = words[j - i];
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
