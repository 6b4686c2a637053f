#pragma once
#include "core/effects/effects.h"
#include "core/sky/places/observer.h"
#include "core/sky/places/star_place.h"
#include "core/sky/places/star_place_kernels.h"

namespace dmise {

/// Proper motion and radial velocity from the catalogue's epoch to the observer's time.
class ProperMotion {
 public:
  static constexpr EffectFacts facts{
      "proper_motion", "stars move from their catalogue's epoch to the date",
      "up to 10.4 arcsec a year (Barnard's star)", "IAU SOFA, eraPmpx"};

  static ErrorBound error(int, const PlanFacts& f);
  static double cost_s(int level, const PlanFacts& f);

  explicit ProperMotion(const Observer& observer);
  /// `place`: of the star, in units of its distance.
  void apply(const CataloguedStar& catalogued, Vec<Gcrs>& place) const;
  /// Moves many stars of one epoch, without radial velocities.
  void apply(double epoch_jyear, CatalogueMotion& motion) const;

 private:
  Vec<Gcrs> barycentric_au_;
  double years_;  // the observer's time as a Julian year
};

}  // namespace dmise
