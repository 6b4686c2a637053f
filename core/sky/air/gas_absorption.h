#pragma once
#include <memory>
#include <vector>

#include "core/effects/effects.h"
#include "core/sky/air/air_exposure.h"
#include "core/sky/air/air_gases.h"

namespace dmise {

/// Share of a band's light that passes the gases, of what passes the rest of the air: a table over
/// B-V and airmass, within 0.2 % of the integral.
class BandGases {
 public:
  /// `extinction` [mag/airmass] of the rest of the air.
  BandGases(const Band& band, const Curve& extinction, const AirGases& gases);
  /// For a star of this B-V; airmass in [0, 40], beyond it is clamped.
  double of_star(double airmass, double bv) const;

 private:
  std::vector<double> log_of_transmission_;  // colours x airmasses
};

/// Water vapour, oxygen, carbon dioxide and methane absorb in bands from 0.59 um on.
class GasAbsorption {
 public:
  static constexpr EffectFacts facts{
      "gas_absorption", "water vapour and oxygen absorb (with weather: {pwv_mm})",
      "0.02 to 0.2 mag in I, J, H and K; all of the light at 1.4 and 1.9 um",
      "Bird & Riordan 1986, J. Climate Appl. Meteor. 25, 87"};
  static bool applies(const SceneFacts& scene) { return scene.on_ground && scene.gases; }
  static ErrorBound error(int, const PlanFacts& f);
  static double cost_s(int level, const PlanFacts& f);

  explicit GasAbsorption(const AirExposure& exposure);
  /// Share of a source's light in the band that arrives, (0, 1].
  double apply(const SightLine& line) const;
  /// Absorption of sunlight in the band at an airmass [mag].
  double sunlight_mag(double airmass) const;

 private:
  std::shared_ptr<const BandGases> table_;
  Vec<Gcrs> up_;
};

}  // namespace dmise
