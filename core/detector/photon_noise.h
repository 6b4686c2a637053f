#pragma once
#include "core/detector/detector_effect.h"

namespace dmise {

/// Replaces the expected electrons of every pixel by a Poisson deviate.
struct PhotonNoise {
  static constexpr EffectFacts facts{"photon_noise", "photons arrive at random (Poisson)",
                                     "expected electrons instead of a draw",
                                     "Giles 2016, ACM TOMS 42, 7"};
  bool photons_are_drawn = true;
  bool operator==(const PhotonNoise&) const = default;

  static std::span<const DetectorParameter> parameters() { return {}; }
  void switch_off() { photons_are_drawn = false; }
  bool applies(const Detector&) const { return photons_are_drawn; }
  void apply(const ExposureFacts& exposed, Piece& piece) const;
};

}  // namespace dmise
