#pragma once
#include "core/detector/noise/detector_effect.h"

namespace dmise {

/// Replaces the expected electrons of every pixel by a Poisson deviate.
struct PhotonNoise {
  /// "gaussian": one normal deviate of the variance of light, dark current and read-out.
  static constexpr std::array<std::string_view, 3> levels{"off", "gaussian", "exact"};
  static constexpr int gaussian = 1;
  static constexpr EffectFacts facts{"photon_noise",
                                     "photons arrive at random (Poisson)",
                                     "expected electrons instead of a draw",
                                     "Giles 2016, ACM TOMS 42, 7",
                                     true,
                                     true,
                                     levels};
  bool photons_are_drawn = true;
  // With the Gaussian draw: what it draws together with the photons.
  bool is_gaussian = false;
  double drawn_dark_e_per_s = 0.0, drawn_read_noise_e = 0.0;
  bool operator==(const PhotonNoise&) const = default;

  static std::span<const ParameterOf<PhotonNoise>> parameters() { return {}; }
  void switch_off() { photons_are_drawn = false; }
  bool applies(const Detector&) const { return photons_are_drawn; }
  void apply(const ExposureFacts& exposed, Piece& piece) const;

  /// What the Gaussian draw, held at 0 where read noise does not belong to it, lacks at its 3
  /// sigma quantile of a Poisson deviate with read noise, by the skewness (Cornish & Fisher
  /// 1938), in the worst pixel at least as bright as the sky.
  static ErrorBound error(int level, const PlanFacts& f);
  /// With the draws of dark current and read noise, which the Gaussian one replaces.
  static double cost_s(int level, const PlanFacts& f);
};

}  // namespace dmise
