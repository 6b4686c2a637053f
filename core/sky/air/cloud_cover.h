#pragma once
#include <memory>

#include "core/effects/accuracy.h"
#include "core/effects/effects.h"
#include "core/sky/air/air_exposure.h"

namespace dmise {

/// Clouds dim what is above them.
class CloudCover {
 public:
  static constexpr EffectFacts facts{"clouds", "clouds dim what is above them",
                                     "as if the sky were clear",
                                     "a map of optical depth that the wind moves"};
  static bool applies(const SceneFacts& scene) { return scene.on_ground && scene.clouds; }

  static ErrorBound error(int, const PlanFacts&) { return not_bounded; }
  static double cost_s(int level, const PlanFacts& f);

  explicit CloudCover(const AirExposure& exposure);
  /// Share of a source's light that comes through, [0, 1].
  double apply(const SightLine& line) const {
    return map_->transmission(enu_from_gcrs_ * line.apparent, time_s_);
  }

 private:
  std::shared_ptr<const CloudMap> map_;
  Rotation<Enu, Gcrs> enu_from_gcrs_;
  double time_s_;
};

}  // namespace dmise
