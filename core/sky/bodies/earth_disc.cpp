#include "core/sky/bodies/earth_disc.h"

#include <cmath>

#include "core/base/units.h"
#include "core/effects/plan_facts.h"
#include "core/photometry/magnitude.h"

namespace dmise {

ErrorBound EarthDisc::error(int, const PlanFacts& f) {
  return f.scene.earth_in_field ? not_bounded : ErrorBound{};
}

double EarthDisc::cost_s(int level, const PlanFacts& f) { return level * 200e-9 * f.pixels(); }

EarthRadiance::EarthRadiance(const Band& band, const Vec<Gcrs>& from_m, const Vec<Gcrs>& sun_m,
                             const OblateEarth& earth, double albedo)
    : earth_(earth), from_(earth.stretched(from_m)), to_sun_(unit(sun_m)) {
  const double radius_m = earth.ellipsoid.equatorial_radius_m;
  beyond_m2_ = dot(from_, from_) - radius_m * radius_m;
  const double au = norm(sun_m) / au_m;
  full_ = albedo / pi * sunlight_photons_per_s_m2(sun_v_mag, band) / (au * au);
}

double EarthRadiance::photons_per_s_m2_sr(const Vec<Gcrs>& direction) const {
  const Vec<Gcrs> line = unit(earth_.stretched(direction));
  const double along_m = -dot(line, from_);
  const double depth_m2 = along_m * along_m - beyond_m2_;
  if (along_m <= 0.0 || depth_m2 < 0.0) return -1.0;
  const Vec<Gcrs> ground = from_ + line * (along_m - std::sqrt(depth_m2));
  // Stretched once more, a place of the stretched sphere is along the ellipsoid's normal.
  const double lit = dot(unit(earth_.stretched(ground)), to_sun_);
  return lit > 0.0 ? full_ * lit : 0.0;
}

}  // namespace dmise
