#pragma once
#include <memory>
#include <vector>

#include "core/effects/effects.h"
#include "core/photometry/band.h"
#include "core/sky/air/air_gases.h"

namespace dmise {

/// The air's own heat: gases radiate by their temperature where they absorb. Brightest towards the
/// horizon.
struct ThermalSky {
  static constexpr EffectFacts facts{
      "thermal_sky", "heat of the air, in bands that reach beyond 1.9 um",
      "beyond 3 um nearly all light of the sky: 2e6 times the airglow of V at 10 um",
      "Planck's law and LOWTRAN 7, Kneizys et al. 1988"};
  static bool applies(const SceneFacts& scene) { return scene.on_ground && scene.thermal; }
  static ErrorBound error(int, const PlanFacts& f);
  static double cost_s(int level, const PlanFacts& f);
};

/// Radiance of the air in a band over airmass: a table, within 1 % of the integral. Water and mixed
/// gases radiate at the site's temperature less 6.5 K for each km of their height, ozone behind
/// them at 225 K over 600 hPa, 234 K over the sea. Within 5 % of LOWTRAN's own sums over layers in
/// the U.S. Standard Atmosphere
/// (`ThermalSky.IsTheRadianceOfLowtran`). Beyond the table's ends (2.5 and 25 um) absorption is
/// that of `gas_transmission`, at a height of 1.5 km.
class AirRadiance {
 public:
  AirRadiance(const Band& band, const AirGases& gases);
  /// `sin_altitude` is held at 0 below it.
  double photons_per_s_m2_sr(double sin_altitude) const;

 private:
  std::shared_ptr<const std::vector<double>> by_airmass_;
};

}  // namespace dmise
