#include "core/detector/persistence.h"

#include <cmath>
#include <cstddef>

namespace dmise {

void release_trapped(double tau_s, double idle_s, double exposure_s, std::span<float> trapped_e,
                     std::span<float> light_e) {
  const auto before = float(std::exp(-idle_s / tau_s));
  const auto kept = float(std::exp(-exposure_s / tau_s));
  for (std::size_t i = 0; i < light_e.size(); ++i) {
    const float held = trapped_e[i] * before;
    light_e[i] += held * (1.0f - kept);
    trapped_e[i] = held * kept;
  }
}

void trap(double fraction, std::span<const float> collected_e, std::span<float> trapped_e) {
  for (std::size_t i = 0; i < collected_e.size(); ++i)
    trapped_e[i] += float(fraction) * collected_e[i];
}

}  // namespace dmise
