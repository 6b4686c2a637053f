#pragma once
#include "core/detector/noise/detector_effect.h"

namespace dmise {

/// The gain register of an electron-multiplying CCD, in which each of many stages multiplies an
/// electron with a small probability, and the clock-induced charge before it. n electrons become
/// n + Poisson(Gamma(a n, (G - 1) / a)), of the mean n G; a, about 1, gives the variance of Robbins
/// & Hadwen 2003 for the number of stages. Without limit of the stages this is the negative
/// binomial distribution, at large gains the Gamma distribution. The image holds electrons before
/// the register: `read_noise_e` and `gain_e_per_dn` are those of the amplifier behind it, divided
/// by G.
struct EmGain {
  static constexpr EffectFacts facts{
      "em_gain", "a register multiplies electrons at random",
      "shot noise smaller by up to the root of 2; no clock-induced charge",
      "Robbins & Hadwen 2003, IEEE Trans. Electron Devices 50, 1227; Basden et al. 2003, MNRAS "
      "345, 985"};
  double em_gain = 1.0;  // mean; 1: no register
  int em_stages = 536;
  double clock_induced_e = 0.0;  // mean of a pixel, Poisson
  bool operator==(const EmGain&) const = default;

  static std::span<const ParameterOf<EmGain>> parameters();
  static std::optional<DetectorFault> fault(const EmGain& own);
  void switch_off() {
    em_gain = 1.0;
    clock_induced_e = 0.0;
  }
  bool applies(const Detector&) const { return em_gain > 1.0 || clock_induced_e > 0.0; }
  void apply(const ExposureFacts& exposed, Piece& piece) const;
  static ErrorBound error(int, const PlanFacts&) { return not_bounded; }
  static double cost_s(int level, const PlanFacts& f);

  /// Returns the variance behind the register, in electrons before it, over that of shot noise: 1
  /// to 2.
  double excess_noise2() const;
};

}  // namespace dmise
