#pragma once
#include "core/detector/noise/detector_effect.h"

namespace dmise {

/// A fraction of every pixel's signal appears in each of its four neighbours instead.
struct InterpixelCoupling {
  static constexpr EffectFacts facts{
      "interpixel_coupling", "part of a pixel's signal appears in its neighbours",
      "noise of neighbours uncorrelated; shot noise looks 1 - 8 times the coupling smaller with it",
      "Moore, Ninkov & Forrest 2006, Opt. Eng. 45, 076402"};
  double interpixel_coupling = 0.0;  // share seen by each of four neighbours
  bool operator==(const InterpixelCoupling&) const = default;

  static std::span<const ParameterOf<InterpixelCoupling>> parameters();
  void switch_off() { interpixel_coupling = 0.0; }
  bool applies(const Detector&) const { return interpixel_coupling > 0.0; }
  void apply(const ExposureFacts& exposed, const ElectronImage& electrons, Piece& piece) const;
  static ErrorBound error(int, const PlanFacts&) { return not_bounded; }
  static double cost_s(int level, const PlanFacts& f);
};

/// Signal of the pixels from `first` on: e + coupling x the sum of (neighbour - e).
void couple(double coupling, const ElectronImage& electrons, std::size_t first,
            std::span<float> signal);

}  // namespace dmise
