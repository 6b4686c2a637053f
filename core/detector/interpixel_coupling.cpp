#include "core/detector/interpixel_coupling.h"

#include <algorithm>

#include "core/detector/detector.h"
#include "core/effects/plan_facts.h"

namespace dmise {

double InterpixelCoupling::cost_s(int level, const PlanFacts& f) {
  return level * 1.3e-9 * f.pixels();
}

std::span<const ParameterOf<InterpixelCoupling>> InterpixelCoupling::parameters() {
  static constexpr ParameterOf<InterpixelCoupling> table[] = {
      {"interpixel_coupling", "IPC", "share of signal seen by each neighbour",
       &InterpixelCoupling::interpixel_coupling, 0.0, 0.2}};
  return table;
}

void InterpixelCoupling::apply(const ExposureFacts&, const ElectronImage& electrons,
                               Piece& piece) const {
  couple(interpixel_coupling, electrons, piece.first, piece.electrons);
}

void couple(double coupling, const ElectronImage& electrons, std::size_t first,
            std::span<float> signal) {
  const auto columns = std::size_t(electrons.columns), rows = std::size_t(electrons.rows);
  const auto share = float(coupling);
  // Row by row; a missing neighbour is replaced by the pixel itself, which contributes nothing.
  for (std::size_t i = 0; i < signal.size();) {
    const std::size_t y = (first + i) / columns, begin = (first + i) % columns;
    const std::size_t end = std::min(columns, begin + signal.size() - i);
    const float* here = electrons.row(int(y));
    const float* above = y > 0 ? here - columns : here;
    const float* below = y + 1 < rows ? here + columns : here;
    const auto couple_at = [&](std::size_t x, std::size_t left, std::size_t right) {
      const float e = here[x];
      signal[i + (x - begin)] =
          e + share * ((here[left] - e) + (here[right] - e) + (above[x] - e) + (below[x] - e));
    };
    std::size_t x = begin;
    if (x == 0) couple_at(0, 0, std::min<std::size_t>(1, columns - 1)), ++x;
    for (const std::size_t inner = std::min(end, columns - 1); x < inner; ++x)
      couple_at(x, x - 1, x + 1);
    if (x < end) couple_at(x, x - 1, x);
    i += end - begin;
  }
}

}  // namespace dmise
