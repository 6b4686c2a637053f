#include "core/detector/persistence.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/error.h"

namespace dmise {

std::uint32_t persistence_window(double persistence_s, double cadence_s) {
  const double frames = -std::log(persistence_forgotten) * persistence_s / cadence_s;
  return static_cast<std::uint32_t>(std::clamp(std::ceil(frames), 1.0, 4e9));
}

std::uint32_t persistence_first_frame(const Detector& d, double cadence_s, std::uint32_t frame) {
  if (!(d.persistence_fraction > 0.0) || frame == 0) return frame;
  const std::uint32_t window = persistence_window(d.persistence_s, cadence_s);
  const std::uint32_t windows = (frame - 1) / window;
  return windows == 0 ? 1 : 1 + (windows - 1) * window;
}

void begin_frame(PersistenceMemory& memory, std::uint32_t frame, std::uint32_t window,
                 std::size_t pixels) {
  if (memory.next_frame == 0) {
    memory.trapped_e.assign(pixels, 0.0f);
    memory.younger_e.clear();
  } else if (memory.next_frame != frame || memory.trapped_e.size() != pixels) {
    throw Error("persistence: traps wait for frame " + std::to_string(memory.next_frame) + " of " +
                std::to_string(memory.trapped_e.size()) + " pixels, got frame " +
                std::to_string(frame) + " of " + std::to_string(pixels));
  } else if ((frame - 1) % window == 0) {
    if (!memory.younger_e.empty()) memory.trapped_e.swap(memory.younger_e);
    memory.younger_e.assign(pixels, 0.0f);
  }
  memory.next_frame = frame + 1;
}

Release::Release(double tau_s, double idle_s, double exposure_s)
    : kept_idle(float(std::exp(-idle_s / tau_s))),
      kept_exposed(float(std::exp(-exposure_s / tau_s))) {}

void Release::apply(std::span<float> trapped_e, std::span<float> released_e) const {
  for (std::size_t i = 0; i < trapped_e.size(); ++i) {
    const float held = trapped_e[i] * kept_idle;
    released_e[i] = held * (1.0f - kept_exposed);
    trapped_e[i] = held * kept_exposed;
  }
}

void Release::apply(std::span<float> trapped_e) const {
  for (float& e : trapped_e) e = e * kept_idle * kept_exposed;
}

void trap(double fraction, double full_well_e, std::span<const float> collected_e,
          std::span<float> trapped_e) {
  const auto share = float(fraction), well = float(full_well_e);
  for (std::size_t i = 0; i < collected_e.size(); ++i)
    trapped_e[i] += share * std::min(collected_e[i], well);
}

}  // namespace dmise
