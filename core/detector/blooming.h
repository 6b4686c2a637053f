#pragma once
#include "core/detector/noise/detector_effect.h"

namespace dmise {

/// Charge above the full well flows along its column, half up and half down, into pixels below
/// their well; charge that reaches an end of the column is drained.
struct Blooming {
  static constexpr EffectFacts facts{"blooming", "charge above the full well flows along columns",
                                     "it is lost",
                                     "Janesick 2001, Scientific Charge-Coupled Devices"};
  bool blooming = false;
  bool operator==(const Blooming&) const = default;

  static std::span<const ParameterOf<Blooming>> parameters();
  void switch_off() { blooming = false; }
  bool applies(const Detector& detector) const;
  void apply(const ExposureFacts& exposed, const WholeImage& image) const;
  static ErrorBound error(int, const PlanFacts&) { return not_bounded; }
  static double cost_s(int level, const PlanFacts& f);
};

/// Returns how many pixels are full afterwards. Sets `flag_full_well` and `flag_bloomed` if `flags`
/// are given.
std::size_t bloom(double full_well_e, ElectronImage& electrons, Threads& threads,
                  FlagImage* flags = nullptr);

}  // namespace dmise
