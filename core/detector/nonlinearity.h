#pragma once
#include "core/detector/noise/detector_effect.h"

namespace dmise {

/// e (1 - l e / W): a relative loss l at the full well W.
struct Nonlinearity {
  static constexpr EffectFacts facts{"nonlinearity", "the amplifier's gain falls with the signal",
                                     "a straight response", "Janesick 2007, Photon Transfer"};
  double nonlinearity = 0.0;  // relative loss of signal at full well, 0..0.5
  bool operator==(const Nonlinearity&) const = default;

  static std::span<const ParameterOf<Nonlinearity>> parameters();
  void switch_off() { nonlinearity = 0.0; }
  bool applies(const Detector&) const { return nonlinearity > 0.0; }
  void apply(const ExposureFacts& exposed, Piece& piece) const;
  static ErrorBound error(int, const PlanFacts&) { return not_bounded; }
  static double cost_s(int level, const PlanFacts& f);
};

}  // namespace dmise
