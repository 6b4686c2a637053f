#pragma once
#include <memory>

#include "core/effects/effects.h"
#include "core/sky/air/air_exposure.h"
#include "core/sky/air/extinction.h"

namespace dmise {

/// Clear air dims what is seen from the ground.
class AirExtinction {
 public:
  static constexpr EffectFacts facts{
      "extinction", "the atmosphere dims what is seen from the ground", "0.1 to 0.4 mag an airmass",
      "Kasten & Young 1989, Applied Optics 28, 4735"};
  static bool applies(const SceneFacts& scene) { return scene.on_ground; }

  static ErrorBound error(int, const PlanFacts& f);
  static double cost_s(int level, const PlanFacts& f);

  explicit AirExtinction(const AirExposure& exposure);
  /// Share of a source's light in the band that arrives, (0, 1].
  double apply(const SightLine& line) const;
  void apply(const SightLines& lines, std::span<double> factors) const;
  /// Returns the zenith's extinction of sunlight in the band.
  double sunlight_mag_per_airmass() const;

 private:
  std::shared_ptr<const BandExtinction> table_;
  Vec<Gcrs> up_;
};

}  // namespace dmise
