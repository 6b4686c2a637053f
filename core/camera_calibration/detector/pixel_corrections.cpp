#include "core/camera_calibration/detector/pixel_corrections.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace dmise {

void uncouple(double coupling, int columns, std::vector<float>& values) {
  if (coupling == 0.0) return;
  constexpr int rounds = 3;  // each leaves some 8 couplings of what is missing
  const auto across = std::size_t(columns), rows = values.size() / across;
  const std::vector<float> seen = values;
  for (int round = 0; round < rounds; ++round) {
    const std::vector<float> before = values;
    for (std::size_t y = 1; y + 1 < rows; ++y)
      for (std::size_t x = 1; x + 1 < across; ++x) {
        const std::size_t i = y * across + x;
        const float around =
            before[i - 1] + before[i + 1] + before[i - across] + before[i + across];
        values[i] = seen[i] + float(coupling) * (4 * before[i] - around);
      }
  }
}

void straighten(double loss_per_dn, std::vector<float>& light) {
  if (loss_per_dn == 0.0) return;
  for (float& v : light) {
    const double bend = std::clamp(loss_per_dn * double(v), -0.2, 0.2);
    v = float(2 * double(v) / (1 + std::sqrt(1 - 4 * bend)));
  }
}

}  // namespace dmise
