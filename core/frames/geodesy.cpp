#include "core/frames/geodesy.h"

#include <GeographicLib/Geocentric.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "core/base/error.h"

namespace dmise {
namespace {

GeographicLib::Geocentric geocentric(const Ellipsoid& e) {
  if (!(e.equatorial_radius_m > 0.0) || !(e.flattening >= 0.0 && e.flattening < 1.0))
    throw Error("not an ellipsoid: equatorial radius " + std::to_string(e.equatorial_radius_m) +
                " m, flattening " + std::to_string(e.flattening));
  return {e.equatorial_radius_m, e.flattening};
}

void check(const Site& site) {
  if (!(std::abs(site.latitude_deg) <= 90.0))
    throw Error("latitude_deg: must be in [-90, 90], got " + std::to_string(site.latitude_deg));
  if (!std::isfinite(site.longitude_deg) || !std::isfinite(site.height_m))
    throw Error("longitude_deg and height_m: must be finite");
}

}  // namespace

Vec<Itrs> itrs_from_geodetic(const Site& site) {
  check(site);
  Vec<Itrs> r;
  geocentric(site.ellipsoid)
      .Forward(site.latitude_deg, site.longitude_deg, site.height_m, r.x, r.y, r.z);
  return r;
}

Site geodetic_from_itrs(const Vec<Itrs>& position_m, const Ellipsoid& ellipsoid) {
  Site site{.ellipsoid = ellipsoid};
  geocentric(ellipsoid).Reverse(position_m.x, position_m.y, position_m.z, site.latitude_deg,
                                site.longitude_deg, site.height_m);
  check(site);
  return site;
}

Rotation<Enu, Itrs> enu_from_itrs(const Site& site) {
  check(site);
  double x, y, z;
  std::vector<double> m(9);  // columns are east, north, up in ITRS
  geocentric(site.ellipsoid)
      .Forward(site.latitude_deg, site.longitude_deg, site.height_m, x, y, z, m);
  Rotation<Enu, Itrs> r;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) r.m[i][j] = m[3 * j + i];
  return r;
}

Horizontal horizontal(const Vec<Enu>& v) {
  double azimuth = std::atan2(v.x, v.y);
  if (azimuth < 0.0) azimuth += 2 * pi;
  if (azimuth >= 2 * pi) azimuth = 0.0;  // a negative angle below the rounding of a turn
  return {azimuth, std::atan2(v.z, std::hypot(v.x, v.y))};
}

}  // namespace dmise
