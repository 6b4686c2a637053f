#pragma once
#include "core/detector/noise/detector_effect.h"

namespace dmise {

/// Amplifier and converter: round(e / gain + bias) within 0 and 2^bits - 1. If it is off, counts
/// are whole electrons without bias, limited to 16 bits.
struct Quantisation {
  static constexpr EffectFacts facts{"quantisation", "gain, bias, ADC range and rounding",
                                     "one DN an electron, no bias, 16 bits", "EMVA Standard 1288"};
  double gain_e_per_dn = 1.0;
  double bias_dn = 0.0;
  int adc_bits = 16;  // 1..16: counts are 16-bit numbers in frames and messages
  bool operator==(const Quantisation&) const = default;

  static std::span<const ParameterOf<Quantisation>> parameters();
  static std::optional<DetectorFault> fault(const Quantisation& own);
  void switch_off() { *this = {}; }
  bool applies(const Detector&) const { return true; }  // a frame always has counts
  void apply(const ExposureFacts& exposed, Piece& piece) const;
  static double cost_s(int, const PlanFacts& f);
};

}  // namespace dmise
