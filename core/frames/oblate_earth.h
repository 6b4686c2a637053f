#pragma once
#include "core/frames/earth_orientation.h"
#include "core/frames/geodesy.h"

namespace dmise {

/// The Earth's surface as a body in GCRS: an ellipsoid of revolution about `pole`.
struct OblateEarth {
  Vec<Gcrs> pole{0, 0, 1};  // unit
  Ellipsoid ellipsoid = wgs84;

  /// Scales space along the axis so that the ellipsoid becomes a sphere of the equatorial radius.
  /// The map is linear: straight lines stay straight and tangents stay tangents.
  Vec<Gcrs> stretched(const Vec<Gcrs>& v) const {
    const double f = ellipsoid.flattening;
    return v + pole * (dot(v, pole) * (f / (1 - f)));
  }
};

/// With the axis at the celestial intermediate pole, at most 0.3 arcsec from the figure axis.
inline OblateEarth oblate_earth(const EarthOrientation& earth, const Ellipsoid& ellipsoid = wgs84) {
  return {earth.cirs_from_gcrs.inverse() * Vec<Cirs>{0, 0, 1}, ellipsoid};
}

/// Whether a position is at least 1 m above the ellipsoid, as one of an object that moves freely
/// must be.
inline bool is_above_ground(const Vec<Gcrs>& position_m, const EarthOrientation& earth,
                            const Ellipsoid& ellipsoid) {
  constexpr double min_height_m = 1.0;
  const OblateEarth body = oblate_earth(earth, ellipsoid);
  return norm(body.stretched(position_m)) > body.ellipsoid.equatorial_radius_m + min_height_m;
}

}  // namespace dmise
