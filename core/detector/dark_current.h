#pragma once
#include "core/detector/detector_effect.h"
#include "core/detector/poisson.h"

namespace dmise {

/// Dark current at a temperature, doubling every `doubling_k` kelvin from a reference [e-/s].
/// Temperatures may be on any scale of kelvins.
double dark_current_at(double temperature_k, double reference_e_per_s, double reference_k,
                       double doubling_k);

/// Thermally generated electrons: a Poisson deviate in every pixel (its sum with the
/// photo-electrons is distributed as one draw of the summed means).
struct DarkCurrent {
  static constexpr EffectFacts facts{"dark_current", "thermally generated electrons", "none",
                                     "Janesick 2001, Scientific Charge-Coupled Devices"};
  double dark_e_per_s = 0.0;      // at dark_reference_c
  double dark_reference_c = 0.0;  // [deg C]
  double temperature_c = 0.0;     // of the detector [deg C]
  double dark_doubling_k = 0.0;   // temperature rise that doubles dark current; 0: constant
  bool operator==(const DarkCurrent&) const = default;

  static std::span<const DetectorParameter> parameters();
  static std::optional<DetectorFault> fault(const Detector& detector);
  void switch_off() { dark_e_per_s = 0.0; }
  bool applies(const Detector&) const { return dark_e_per_s > 0.0; }
  using Prepared = ConstantPoisson;
  Prepared prepare(const ExposureFacts& exposed) const;
  void apply(const ExposureFacts& exposed, const Prepared& deviates, Piece& piece) const;

  /// Its time is in that of the photons' noise.
  static ErrorBound error(int, const PlanFacts& f) { return f.without_charge(f.dark_e); }

  /// Factor of the dark current from the reference to the detector's temperature.
  double thermal_factor() const;
};

/// Dark current of an ordinary pixel at the detector's temperature.
double dark_rate_e_per_s(const DarkCurrent& dark);

}  // namespace dmise
