#pragma once
#include <vector>

#include "core/detector/noise/detector_effect.h"

namespace dmise {

/// Amplifiers of pixels and of columns (CMOS) differ. Each multiplies what it reads, noise
/// included, by a gain and adds an offset of its own: normal deviates, the same in every frame of
/// the sensor.
struct FixedPattern {
  static constexpr EffectFacts facts{
      "fixed_pattern", "amplifiers of pixels and columns differ in gain and offset",
      "a fixed pattern: 0.01 of the signal and 1 to 10 e- in a usual CMOS camera",
      "Konnik & Welsh 2014, arXiv:1412.4031, section 2.3"};
  double pixel_gain_rms = 0.0, column_gain_rms = 0.0;  // relative
  double pixel_offset_e = 0.0, column_offset_e = 0.0;  // rms
  bool operator==(const FixedPattern&) const = default;

  static std::span<const ParameterOf<FixedPattern>> parameters();
  void switch_off() { *this = {}; }
  bool applies(const Detector&) const { return *this != FixedPattern{}; }
  /// Gain and offset of a column.
  struct Column {
    float gain = 1.0f, offset_e = 0.0f;
  };
  using Prepared = std::vector<Column>;
  Prepared prepare(const ExposureFacts& exposed) const;
  void apply(const ExposureFacts& exposed, const Prepared& columns, Piece& piece) const;
  ErrorBound error(int, const PlanFacts& f) const;
  static double cost_s(int level, const PlanFacts& f);
};

}  // namespace dmise
