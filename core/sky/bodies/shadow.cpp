#include "core/sky/bodies/shadow.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/formatted.h"
#include "core/effects/plan_facts.h"
#include "core/sky/air/kept_tables.h"
#include "core/sky/bodies/sun_disc.h"

namespace dmise {
namespace {

// The cheap tests hold for any Sun from 0.98 au on and any object out to 2e8 m.
constexpr double margin_m = 110e3;
constexpr double max_bending = 0.021;  // a ray along the ground is bent no more

// A unit vector across `v` in the plane of `v` and `towards`; any across `v` when these are
// parallel.
Vec<Gcrs> across(const Vec<Gcrs>& v, const Vec<Gcrs>& towards) {
  const Vec<Gcrs> part = towards - v * (dot(towards, v) / dot(v, v));
  if (norm(part) > 1e-12 * norm(towards)) return unit(part);
  const Vec<Gcrs> other = std::abs(v.x) < 0.6 * norm(v) ? Vec<Gcrs>{1, 0, 0} : Vec<Gcrs>{0, 1, 0};
  return unit(cross(v, other));
}

}  // namespace

ErrorBound EarthShadow::error(int level, const PlanFacts& f) {
  const bool lacks = level == 0 ? f.near_shadow || f.near_shadow_of_air : f.near_shadow_of_air;
  return lacks ? not_bounded : ErrorBound{};
}

double EarthShadow::cost_s(int level, const PlanFacts& f) {
  constexpr std::array<double, 4> object_s{0.0, 2e-6, 10e-6, 30e-6};
  return object_s[std::size_t(level)] * double(f.objects);
}

EarthShadow::EarthShadow(const Vec<Gcrs>& sun_m, const OblateEarth& earth)
    : sun_m_(sun_m), towards_sun_(unit(sun_m)), earth_(earth) {}

EarthShadow::EarthShadow(const Vec<Gcrs>& sun_m, const OblateEarth& earth, Edge edge,
                         const Band& band)
    : EarthShadow(sun_m, earth) {
  edge_ = edge;
  if (edge != Edge::sharp) band_ = band;
  if (edge == Edge::air) dark_slope_ = cone_slope + max_bending;
}

double EarthShadow::light_of(const LowSun& sun, double distance_m, double radius_m) const {
  if (edge_ == Edge::sharp) return visible_fraction(sun);
  // Made for the first object that is near the shadow: few are.
  static KeptTables<Band, GrazingAir> tables;
  const auto air = tables.of(band_, [&] { return GrazingAir(band_); });
  return edge_ == Edge::limb ? air->light_past_sharp_limb(sun)
                             : air->light(sun, distance_m, radius_m);
}

bool EarthShadow::fully_lit(double along_m, double across_squared_m2) const {
  if (along_m > margin_m) return true;
  const double reach =
      earth_.ellipsoid.equatorial_radius_m + margin_m + cone_slope * std::abs(along_m);
  return across_squared_m2 > reach * reach;
}

bool EarthShadow::fully_dark(double along_m, double across_squared_m2) const {
  if (along_m > -margin_m) return false;
  const double reach = earth_.ellipsoid.polar_radius_m() - margin_m + dark_slope_ * along_m;
  return reach > 0.0 && across_squared_m2 < reach * reach;
}

double EarthShadow::in_penumbra(const Vec<Gcrs>& object_m, const Vec<Gcrs>& stretched_m) const {
  const Vec<Gcrs> to_sun = sun_m_ - object_m;
  // In stretched space the Earth is a sphere: the limb towards the Sun lies in the plane of object,
  // Earth and Sun, and the plane that touches there has the normal below. Planes stay planes, so
  // the Sun's height over it is then taken in true space.
  const double distance = norm(stretched_m);
  const double radius = earth_.ellipsoid.equatorial_radius_m;
  const double sin_limb = std::min(1.0, radius / distance);
  const double cos_limb = std::sqrt((1.0 - sin_limb) * (1.0 + sin_limb));
  const Vec<Gcrs> outwards = stretched_m / distance;
  const Vec<Gcrs> side = across(outwards, earth_.stretched(to_sun));
  const Vec<Gcrs> normal = unit(earth_.stretched(outwards * sin_limb + side * cos_limb));

  const double sun_distance = norm(to_sun);
  const double above = std::asin(std::clamp(dot(normal, to_sun) / sun_distance, -1.0, 1.0));
  return light_of({std::asin(sun_radius_m / sun_distance), above, cos_limb / sin_limb}, distance,
                  radius);
}

double EarthShadow::sunlit_fraction(const Vec<Gcrs>& object_m) const {
  const Vec<Gcrs> stretched_m = earth_.stretched(object_m);
  const double r = norm(stretched_m), radius = earth_.ellipsoid.equatorial_radius_m;
  if (!(r >= radius * (1 - 1e-12)))
    throw Error(formatted("object inside the Earth: position (%.0f, %.0f, %.0f) m", object_m.x,
                          object_m.y, object_m.z));
  const double along = dot(object_m, towards_sun_);
  const double across_squared = dot(object_m, object_m) - along * along;
  if (fully_lit(along, across_squared)) return 1.0;
  if (fully_dark(along, across_squared)) return 0.0;
  return in_penumbra(object_m, stretched_m);
}

std::size_t EarthShadow::sunlit_fractions(std::span<const double> position_m,
                                          std::span<double> fraction) const {
  const std::size_t count = fraction.size();
  if (position_m.size() != 3 * count) throw Error("sunlit_fractions: three positions a fraction");
  const double radius = earth_.ellipsoid.equatorial_radius_m;
  const double clear_squared = (radius + 1.0) * (radius + 1.0);
  std::size_t inside = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec<Gcrs> object_m{position_m[i], position_m[count + i], position_m[2 * count + i]};
    const double squared = dot(object_m, object_m);
    const double along = dot(object_m, towards_sun_);
    const double across_squared = squared - along * along;
    if (!(squared >= clear_squared) && !(norm(earth_.stretched(object_m)) >= radius)) {
      fraction[i] = 0.0;
      ++inside;
    } else if (fully_lit(along, across_squared)) {
      fraction[i] = 1.0;
    } else if (fully_dark(along, across_squared)) {
      fraction[i] = 0.0;
    } else {
      fraction[i] = in_penumbra(object_m, earth_.stretched(object_m));
    }
  }
  return inside;
}

}  // namespace dmise
