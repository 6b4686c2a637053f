#pragma once
#include "core/detector/noise/detector_effect.h"

namespace dmise {

/// A pixel holds at most `full_well_e` electrons; the excess is lost, unless it blooms.
struct FullWell {
  static constexpr EffectFacts facts{"full_well", "limit of electrons per pixel",
                                     "no saturation before the ADC",
                                     "Janesick 2001, Scientific Charge-Coupled Devices"};
  double full_well_e = 1e5;
  bool well_is_limited = true;
  bool operator==(const FullWell&) const = default;

  static std::span<const ParameterOf<FullWell>> parameters();
  void switch_off() { well_is_limited = false; }
  bool applies(const Detector& detector) const;
  void apply(const ExposureFacts& exposed, Piece& piece) const;
  ErrorBound error(int, const PlanFacts& f) const;
  static double cost_s(int level, const PlanFacts& f);
};

}  // namespace dmise
