#include "core/sky/places/proper_motion.h"

#include "core/base/units.h"
#include "core/effects/plan_facts.h"

namespace dmise {
namespace {

constexpr double julian_year_s = 365.25 * day_s;
constexpr double light_years_per_au = au_m / speed_of_light_m_per_s / julian_year_s;

}  // namespace

ErrorBound ProperMotion::error(int, const PlanFacts& f) {
  return f.shifted_stars(f.star_shift_rad);
}

double ProperMotion::cost_s(int level, const PlanFacts& f) { return level * 18e-9 * f.stars; }

ProperMotion::ProperMotion(const Observer& observer)
    : barycentric_au_(barycentric_au(observer)),
      years_(2000.0 + julian_years_since_j2000(observer.time)) {}

void ProperMotion::apply(const CataloguedStar& catalogued, Vec<Gcrs>& place) const {
  const auto& [star, outward, east, north] = catalogued;
  const double receding_per_yr =
      star.radial_velocity_m_per_s * (julian_year_s / au_m) * star.parallax_rad;
  // The light also has to come in from the star's side to the observer.
  const double years =
      years_ - star.epoch_jyear + dot(outward, barycentric_au_) * light_years_per_au;
  place += years * (star.pm_ra_cosdec_rad_per_yr * east + star.pm_dec_rad_per_yr * north +
                    receding_per_yr * outward);
}

void ProperMotion::apply(double epoch_jyear, CatalogueMotion& motion) const {
  const Vec<Gcrs> light_years = light_years_per_au * barycentric_au_;
  motion.moves = 1.0;
  motion.years = years_ - epoch_jyear;
  motion.light_years[0] = light_years.x;
  motion.light_years[1] = light_years.y;
  motion.light_years[2] = light_years.z;
}

}  // namespace dmise
