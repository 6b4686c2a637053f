#include "sensors/render/box_filter.h"

#include <algorithm>

namespace dmise {

void add_box_means(const float* samples, const TileBox& box, int oversampling,
                   std::size_t first_band, bool with_coverage, Tile& tile) {
  using Four = float __attribute__((vector_size(16)));
  const std::size_t n = std::size_t(oversampling);
  const std::size_t row_samples = std::size_t(box.columns) * n;
  const std::size_t bands = std::size_t(tile.bands);
  const std::size_t channels = std::min<std::size_t>(3, bands - first_band);
  const float share = 1.0f / float(n * n);
  std::vector<Four> sums(std::size_t(box.columns));
  for (int y = 0; y < box.rows; ++y) {
    std::fill(sums.begin(), sums.end(), Four{});
    for (std::size_t sy = 0; sy < n; ++sy) {
      const float* row = samples + 4 * row_samples * (std::size_t(y) * n + sy);
      for (std::size_t x = 0; x < sums.size(); ++x) {
        Four sum = sums[x];
        for (std::size_t sx = 0; sx < n; ++sx) {
          Four sample;
          __builtin_memcpy(&sample, row + 4 * (x * n + sx), sizeof sample);
          sum += sample;
        }
        sums[x] = sum;
      }
    }
    const std::size_t first =
        std::size_t(box.top + y) * std::size_t(tile.columns) + std::size_t(box.left);
    for (std::size_t x = 0; x < sums.size(); ++x) {
      const Four mean = sums[x] * share;
      for (std::size_t k = 0; k < channels; ++k)
        tile.radiance[(first + x) * bands + first_band + k] += mean[k];
      if (with_coverage) tile.coverage[first + x] += mean[3];
    }
  }
}

}  // namespace dmise
