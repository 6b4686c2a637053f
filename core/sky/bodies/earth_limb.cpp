#include "core/sky/bodies/earth_limb.h"

#include <algorithm>
#include <cmath>

#include "core/base/numeric/golden_section.h"
#include "core/base/units.h"
#include "core/sky/bodies/occultation.h"

namespace dmise {
namespace {

/// The Earth's limb from one place, by the side of it.
class Limb {
 public:
  Limb(const Vec<Gcrs>& from_m, const OblateEarth& earth) : earth_(earth) {
    // In stretched space the Earth is a sphere, and planes stay planes.
    const Vec<Gcrs> from = earth.stretched(from_m);
    const double distance = norm(from);
    down_ = from * (-1.0 / distance);
    sine_ = std::min(1.0, earth.ellipsoid.equatorial_radius_m / distance);
    cosine_ = std::sqrt((1.0 - sine_) * (1.0 + sine_));
  }
  const Vec<Gcrs>& down() const { return down_; }
  Vec<Gcrs> any_side() const {
    return unit(cross(down_, std::abs(down_.z) < 0.9 ? Vec<Gcrs>{0, 0, 1} : Vec<Gcrs>{1, 0, 0}));
  }
  /// `side`: unit, stretched, level.
  Vec<Gcrs> towards(const Vec<Gcrs>& side) const {
    const Vec<Gcrs> tangent = down_ * cosine_ + side * sine_;
    return tangent - earth_.pole * (dot(tangent, earth_.pole) * earth_.ellipsoid.flattening);
  }

 private:
  const OblateEarth& earth_;
  Vec<Gcrs> down_;  // unit, stretched
  double sine_ = 1.0, cosine_ = 0.0;
};

}  // namespace

double above_limb_rad(const Vec<Gcrs>& from_m, const Vec<Gcrs>& direction,
                      const OblateEarth& earth) {
  const Limb limb(from_m, earth);
  const Vec<Gcrs> line = earth.stretched(direction);
  Vec<Gcrs> aside = line - limb.down() * dot(line, limb.down());
  if (!(norm(aside) > 1e-12 * norm(line))) aside = limb.any_side();  // straight down or up
  const double angle = angle_rad(direction, limb.towards(unit(aside)));
  return FreeSight(from_m, earth).clear_direction(direction) ? angle : -angle;
}

double from_limb_rad(const Vec<Gcrs>& from_m, const Vec<Gcrs>& direction,
                     const OblateEarth& earth) {
  constexpr int sides = 36;
  constexpr double step = 2.0 * pi / sides, found_within = 1e-5;
  const Limb limb(from_m, earth);
  const Vec<Gcrs> u = limb.any_side(), v = cross(limb.down(), u);
  const auto angle = [&](double at) {
    return angle_rad(direction, limb.towards(u * std::cos(at) + v * std::sin(at)));
  };
  double nearest = 0.0, least = pi;
  for (int k = 0; k < sides; ++k)
    if (const double here = angle(k * step); here < least) {
      least = here;
      nearest = k * step;
    }
  least =
      std::min(least, golden_section(angle, nearest - step, nearest + step, found_within).value);
  return FreeSight(from_m, earth).clear_direction(direction) ? least : -least;
}

}  // namespace dmise
