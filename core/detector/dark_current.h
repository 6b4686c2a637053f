#pragma once
#include "core/detector/detector_effect.h"
#include "core/detector/poisson.h"

namespace dmise {

/// Dark current that doubles every `doubling_k` kelvin, known at a reference temperature [e-/s].
/// Temperatures on any one scale of kelvins.
double dark_current_at(double temperature_k, double reference_e_per_s, double reference_k,
                       double doubling_k);

/// Electrons that heat frees during the exposure: a Poisson deviate of its own in every pixel (the
/// sum with the photo-electrons is distributed as one draw of the summed means).
struct DarkCurrent {
  static constexpr EffectFacts facts{"dark_current", "electrons that no light freed", "none",
                                     "Janesick 2001, Scientific Charge-Coupled Devices"};
  double dark_e_per_s = 0.0;      // at dark_reference_c
  double dark_reference_c = 0.0;  // [deg C]
  double temperature_c = 0.0;     // of the detector [deg C]
  double dark_doubling_k = 0.0;   // warming that doubles dark current; 0: it never changes
  bool operator==(const DarkCurrent&) const = default;

  static std::span<const DetectorParameter> parameters();
  static std::optional<DetectorFault> fault(const Detector& detector);
  void switch_off() { dark_e_per_s = 0.0; }
  bool applies(const Detector&) const { return dark_e_per_s > 0.0; }
  using Prepared = ConstantPoisson;
  Prepared prepare(const ExposureFacts& exposed) const;
  void apply(const ExposureFacts& exposed, const Prepared& deviates, Piece& piece) const;

  /// By how much the detector's temperature multiplies the dark current of its reference.
  double thermal_factor() const;
};

/// Of an ordinary pixel, at the detector's temperature.
double dark_rate_e_per_s(const DarkCurrent& dark);

}  // namespace dmise
