#include "core/detector/readout/quantisation.h"

#include <cmath>

#include "core/detector/noise/detector_kernels.h"
#include "core/effects/plan_facts.h"

namespace dmise {

double Quantisation::cost_s(int, const PlanFacts& f) { return 0.35e-9 * f.pixels(); }

std::span<const ParameterOf<Quantisation>> Quantisation::parameters() {
  static constexpr ParameterOf<Quantisation> table[] = {
      {"gain_e_per_dn", "", "[e-/DN]", &Quantisation::gain_e_per_dn, 0.0, 1e6, true, true},
      {"bias_dn", "", "[DN] count of no electron", &Quantisation::bias_dn, 0.0, 65535.0},
      {"adc_bits", "ADCBITS", "bits of the ADC", &Quantisation::adc_bits, 1, 16, false, false,
       "counts are 16-bit numbers in frames and messages"}};
  return table;
}

std::optional<DetectorFault> Quantisation::fault(const Quantisation& own) {
  if (own.bias_dn < std::exp2(own.adc_bits)) return std::nullopt;
  return DetectorFault{"bias_dn", "must be below 2^adc_bits", own.bias_dn};
}

void Quantisation::apply(const ExposureFacts& exposed, Piece& piece) const {
  const auto digitise = kernel_of(exposed.level, sse2::digitise, avx2::digitise, avx512::digitise);
  const int highest = (1 << adc_bits) - 1;
  piece.saturated->adc +=
      digitise(piece.electrons.data(), piece.electrons.size(), float(1.0 / gain_e_per_dn),
               float(bias_dn), float(highest), piece.counts);
  for (std::size_t i = 0; i < piece.flags.size(); ++i) {
    const int high = piece.counts[i] == highest ? flag_adc_high : 0;
    piece.flags[i] =
        std::uint8_t(piece.flags[i] | high | (piece.counts[i] == 0 ? flag_adc_low : 0));
  }
}

}  // namespace dmise
