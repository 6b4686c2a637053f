#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/detector/cosmic_rays.h"
#include "core/detector/dark_current.h"
#include "core/detector/effect_watch.h"
#include "core/detector/expose.h"
#include "core/detector/fixed_pattern.h"
#include "core/detector/quantisation.h"

namespace dmise {

/// The effects of one exposure on a piece of the image, and all of them that is prepared before the
/// first pixel. A piece begins at a multiple of rng_group. Empty `flags` are not filled in.
class Chain {
 public:
  /// `detector` as it acts, with the effects that are off out of it (`in_effect`). All arguments
  /// must outlive the chain.
  Chain(const RateImage& light, const Detector& detector, const Exposure& exposure,
        const EffectSet& effects, PersistenceMemory& traps, SimdLevel level, EffectWatch& watch);

  /// Blooming and interpixel coupling need pixels beyond the piece.
  bool needs_neighbours() const { return d_.blooming || d_.interpixel_coupling > 0.0; }

  /// Electrons collected by the pixels from `begin` on; returns how many are full (0 if blooming is
  /// to decide).
  std::size_t collect(std::size_t begin, std::span<float> electrons, std::span<std::uint8_t> flags,
                      EffectWatch& watch) const;
  /// Reads them out; returns how many are at the highest count.
  std::size_t read(std::size_t begin, std::span<float> electrons, std::uint16_t* counts,
                   std::span<std::uint8_t> flags, EffectWatch& watch) const;

 private:
  struct Keys {
    RngKey photons, dark, hot, released, read, response;
  };
  bool on(Effect effect) const { return effects_.has(effect) && has_figure(d_, effect); }
  void collect_released(std::size_t begin, std::span<float> electrons) const;

  const RateImage& light_;
  const Detector& d_;
  const Exposure& exposure_;
  const EffectSet& effects_;
  PersistenceMemory& traps_;
  SimdLevel level_;
  Keys keys_;
  std::optional<DarkCurrent> dark_;
  std::vector<HotPixel> hot_;
  std::vector<CosmicCharge> rays_;
  std::vector<float> columns_;
  std::optional<Release> release_;
};

}  // namespace dmise
