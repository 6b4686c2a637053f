#include "core/base/numeric/rng_at.h"

#include "core/base/error.h"
#include "core/base/numeric/rng_kernels.h"

namespace dmise {

void rng_words_at(const RngKey& key, std::span<const std::uint32_t> pixels, std::uint32_t draw,
                  std::span<std::uint32_t> out, SimdLevel level) {
  if (pixels.size() != out.size()) throw Error("random words: pixels and words differ in number");
  kernel_of(level, sse2::rng_words_at, avx2::rng_words_at, avx512::rng_words_at)(
      key, pixels.data(), pixels.size(), draw, out.data());
}

}  // namespace dmise
