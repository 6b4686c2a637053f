#include "core/detector/column_noise.h"

namespace dmise {

std::vector<float> column_offsets(double rms_e, int columns, const RngKey& key) {
  std::vector<std::uint32_t> words(static_cast<std::size_t>(columns));
  rng_words(key, 0, words.size(), 0, words.data());
  std::vector<float> offsets(words.size());
  normals_of(words.data(), words.size(), offsets.data());
  for (float& e : offsets) e *= float(rms_e);
  return offsets;
}

void add_columns(std::span<const float> offsets_e, std::size_t first, std::span<float> electrons) {
  std::size_t x = first % offsets_e.size();
  for (float& e : electrons) {
    e += offsets_e[x];
    x = x + 1 < offsets_e.size() ? x + 1 : 0;
  }
}

}  // namespace dmise
