#pragma once
#include "core/effects/effects.h"
#include "core/sky/places/observer.h"
#include "core/sky/places/star_place.h"
#include "core/sky/places/star_place_kernels.h"

namespace dmise {

/// Annual parallax: the observer is not at the barycentre of the solar system.
class Parallax {
 public:
  static constexpr EffectFacts facts{"parallax", "stars seen from the Earth's place on its orbit",
                                     "up to 0.77 arcsec", "IAU SOFA, eraPmpx"};

  static ErrorBound error(int, const PlanFacts& f);
  static double cost_s(int level, const PlanFacts& f);

  explicit Parallax(const Observer& observer) : barycentric_au_(barycentric_au(observer)) {}
  /// `place`: of the star, in units of its distance.
  void apply(const CataloguedStar& catalogued, Vec<Gcrs>& place) const {
    place = place - catalogued.star.parallax_rad * barycentric_au_;
  }
  /// Shifts many stars.
  void apply(double, CatalogueMotion& motion) const {
    motion.au[0] = barycentric_au_.x;
    motion.au[1] = barycentric_au_.y;
    motion.au[2] = barycentric_au_.z;
  }

 private:
  Vec<Gcrs> barycentric_au_;
};

}  // namespace dmise
