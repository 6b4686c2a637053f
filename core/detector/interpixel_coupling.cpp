#include "core/detector/interpixel_coupling.h"

namespace dmise {

void interpixel_coupling(double coupling, const ElectronImage& electrons, std::size_t first,
                         std::span<float> signal) {
  const auto columns = std::size_t(electrons.columns), all = electrons.pixels.size();
  const float* e = electrons.pixels.data();
  const auto share = float(coupling);
  for (std::size_t i = 0; i < signal.size(); ++i) {
    const std::size_t p = first + i, x = p % columns;
    float gained = 0.0f;
    if (x > 0) gained += e[p - 1] - e[p];
    if (x + 1 < columns) gained += e[p + 1] - e[p];
    if (p >= columns) gained += e[p - columns] - e[p];
    if (p + columns < all) gained += e[p + columns] - e[p];
    signal[i] = e[p] + share * gained;
  }
}

}  // namespace dmise
