#pragma once
#include "core/detector/noise/detector_effect.h"
#include "core/detector/noise/poisson.h"

namespace dmise {

/// Thermally generated electrons: a Poisson deviate in every pixel (its sum with the
/// photo-electrons is distributed as one draw of the summed means).
struct DarkCurrent {
  static constexpr EffectFacts facts{"dark_current", "thermally generated electrons", "none",
                                     "Janesick 2001, Scientific Charge-Coupled Devices"};
  double dark_e_per_s = 0.0;      // at dark_reference_c
  double dark_reference_c = 0.0;  // [deg C]
  double temperature_c = 0.0;     // the detector's [deg C]
  double dark_doubling_k = 0.0;   // temperature rise that doubles dark current; 0: constant
  bool operator==(const DarkCurrent&) const = default;

  static std::span<const ParameterOf<DarkCurrent>> parameters();
  static std::optional<DetectorFault> fault(const Detector& detector);
  void switch_off() { dark_e_per_s = 0.0; }
  bool applies(const Detector&) const { return dark_e_per_s > 0.0; }
  using Prepared = ConstantPoisson;
  Prepared prepare(const ExposureFacts& exposed) const;
  void apply(const ExposureFacts& exposed, const Prepared& deviates, Piece& piece) const;

  /// Its time is in that of the photons' noise.
  static ErrorBound error(int, const PlanFacts& f);

  /// Factor of the dark current from the reference to the detector's temperature.
  double thermal_factor() const;
};

}  // namespace dmise
