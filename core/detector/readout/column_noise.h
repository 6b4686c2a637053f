#pragma once
#include <vector>

#include "core/detector/noise/detector_effect.h"

namespace dmise {

/// A normal deviate per column, new in each frame.
struct ColumnNoise {
  static constexpr EffectFacts facts{"column_noise",
                                     "random offset of every column, new in each frame", "none",
                                     "normal distribution, assumed"};
  double column_noise_e = 0.0;  // rms
  bool operator==(const ColumnNoise&) const = default;

  static std::span<const ParameterOf<ColumnNoise>> parameters();
  void switch_off() { column_noise_e = 0.0; }
  bool applies(const Detector&) const { return column_noise_e > 0.0; }
  using Prepared = std::vector<float>;  // by column [e-]
  Prepared prepare(const ExposureFacts& exposed) const;
  void apply(const ExposureFacts& exposed, const Prepared& offsets_e, Piece& piece) const;
  /// Only a pixel's noise has an error, because the offsets are new in each frame.
  ErrorBound error(int, const PlanFacts& f) const;
  static double cost_s(int level, const PlanFacts& f);
};

}  // namespace dmise
