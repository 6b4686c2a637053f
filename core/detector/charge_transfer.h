#pragma once
#include "core/detector/noise/detector_effect.h"

namespace dmise {

/// Charge-transfer inefficiency of a CCD: traps take a share of the charge at each transfer and
/// release it behind, exponentially with the time in transfers: trails along columns, away from row
/// 0 where it is read, and along rows, away from column 0. A pixel of row y is transferred y + 1
/// times. What trails behind the last row or column is lost to the overscan.
struct ChargeTransfer {
  static constexpr EffectFacts facts{
      "charge_transfer", "charge is left behind when it is transferred",
      "no trails: transfers times the inefficiency of every source, 0.01 to 0.1 of an old detector",
      "Janesick 2001, Scientific Charge-Coupled Devices, chapter 5"};
  double parallel_cti = 0.0, serial_cti = 0.0;  // share lost a transfer
  double cti_release_px = 0.0;                  // time constant [transfers]; 0: in the next one
  bool operator==(const ChargeTransfer&) const = default;

  static std::span<const ParameterOf<ChargeTransfer>> parameters();
  void switch_off() { parallel_cti = serial_cti = 0.0; }
  bool applies(const Detector&) const { return parallel_cti > 0.0 || serial_cti > 0.0; }
  void apply(const ExposureFacts& exposed, const WholeImage& image) const;
  static ErrorBound error(int, const PlanFacts&) { return not_bounded; }
  static double cost_s(int level, const PlanFacts& f);
};

}  // namespace dmise
