#include "core/detector/persistence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "core/base/error.h"
#include "core/detector/detector.h"
#include "core/detector/noise/poisson.h"
#include "core/effects/plan_facts.h"

namespace dmise {
namespace {

/// Prepares the memory of `pixels` pixels for exposure `frame`. Throws `Error` if it is at another
/// frame.
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

}  // namespace

double Persistence::cost_s(int level, const PlanFacts& f) { return level * 6.6e-9 * f.pixels(); }

std::uint32_t persistence_window(double persistence_s, double cadence_s) {
  const double frames = -std::log(persistence_forgotten) * persistence_s / cadence_s;
  return static_cast<std::uint32_t>(std::clamp(std::ceil(frames), 1.0, 4e9));
}

std::uint32_t persistence_first_frame(const Persistence& p, double cadence_s, std::uint32_t frame) {
  if (!(p.persistence_fraction > 0.0) || frame == 0) return frame;
  const std::uint32_t window = persistence_window(p.persistence_s, cadence_s);
  const std::uint32_t windows = (frame - 1) / window;
  return windows == 0 ? 1 : 1 + (windows - 1) * window;
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

void caught(double fraction, double full_well_e, std::span<const float> collected_e,
            std::span<float> caught_e) {
  const auto share = float(fraction), well = float(full_well_e);
  for (std::size_t i = 0; i < collected_e.size(); ++i)
    caught_e[i] = share * std::min(collected_e[i], well);
}

std::span<const ParameterOf<Persistence>> Persistence::parameters() {
  static constexpr ParameterOf<Persistence> table[] = {
      {"persistence_fraction", "PERSFRAC", "share of the charge that is trapped",
       &Persistence::persistence_fraction, 0.0, 1.0},
      {"persistence_s", "PERSTAU", "[s] time constant of trapped charge",
       &Persistence::persistence_s, 0.0, 1e6}};
  return table;
}

std::optional<DetectorFault> Persistence::fault(const Detector& d) {
  if (d.persistence_fraction == 0.0 || d.persistence_s >= 1e-3) return std::nullopt;
  return DetectorFault{"persistence_s", "must be >= 0.001 with persistence", d.persistence_s};
}

Persistence::Prepared Persistence::prepare(const ExposureFacts& exposed) const {
  const auto& [seed, sensor, frame, exposure_s, idle_s] = exposed.exposure;
  begin_frame(exposed.traps, frame, persistence_window(persistence_s, exposure_s + idle_s),
              exposed.light.pixels.size());
  return Release(persistence_s, idle_s, exposure_s);
}

void Persistence::apply(const ExposureFacts& exposed, const Prepared& release, Piece& piece) const {
  const auto e = piece.electrons;
  const double full_well_e = exposed.detector.full_well_e;
  const auto of_piece = [&](std::vector<float>& traps) {
    return traps.empty() ? std::span<float>() : std::span(traps).subspan(piece.first, e.size());
  };
  const auto trapped = of_piece(exposed.traps.trapped_e);
  const auto younger = of_piece(exposed.traps.younger_e);
  release.apply(younger);
  constexpr std::size_t part = 1024;
  static_assert(part % rng_group == 0);
  std::array<float, part> released, caught_e;
  for (std::size_t i = 0; i < e.size(); i += part) {
    const std::size_t n = std::min(part, e.size() - i);
    const auto here = trapped.subspan(i, n);
    release.apply(here, std::span(released).first(n));
    caught(persistence_fraction, full_well_e, e.subspan(i, n), caught_e);
    if (exposed.detector.photons_are_drawn)
      poisson(exposed.key, std::uint32_t(piece.first + i), released.data(), n, released.data(),
              exposed.level);
    for (std::size_t j = 0; j < n; ++j) {
      here[j] += caught_e[j];
      e[i + j] += released[j] - caught_e[j];
    }
    if (!younger.empty())
      for (std::size_t j = 0; j < n; ++j) younger[i + j] += caught_e[j];
  }
}

}  // namespace dmise
