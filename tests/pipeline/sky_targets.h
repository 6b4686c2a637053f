#pragma once
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "core/base/units.h"
#include "core/frames/earth_orientation.h"
#include "core/frames/geodesy.h"
#include "core/time/iso8601.h"
#include "tests/support/directions.h"

namespace dmise::test {

/// An object that stands in a chosen direction over a site when the run starts, on a circular
/// orbit if it has no radial speed.
struct SkyTarget {
  double azimuth_rad = 0.0, elevation_rad = 0.0;  // over the geodetic horizon, without air
  double altitude_m = 0.0;                        // over a sphere of 6371 km
  double course_rad = 0.0;                        // direction of its motion, about its radius
  double magnitude = 10.0;                        // roughly
  double radial_share = 0.0;                      // radial speed over that of a circular orbit
};

/// Over a sphere: the range at which a line of sight from `from_m` meets an altitude.
inline double range_at_altitude_m(const Vec<Gcrs>& from_m, const Vec<Gcrs>& towards,
                                  double altitude_m) {
  const double along = dot(from_m, towards), radius_m = 6371e3 + altitude_m;
  return -along + std::sqrt(along * along - dot(from_m, from_m) + radius_m * radius_m);
}

/// The targets as a scenario's `objects:`, named t0, t1, ...
inline std::string own_objects(const std::vector<SkyTarget>& targets, const Site& site,
                               const std::string& start_utc) {
  const auto itrs_from_gcrs =
      earth_orientation(Clock(parse_utc(start_utc)), SimTime{0}).itrs_from_gcrs(SimTime{0});
  const auto gcrs_from_enu = (enu_from_itrs(site) * itrs_from_gcrs).inverse();
  const Vec<Gcrs> site_m = itrs_from_gcrs.inverse() * itrs_from_geodetic(site);
  std::string yaml;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const SkyTarget& t = targets[i];
    const Vec<Gcrs> u = gcrs_from_enu * from_horizontal({t.azimuth_rad, t.elevation_rad});
    const double range_m = range_at_altitude_m(site_m, u, t.altitude_m);
    const Vec<Gcrs> at_m = site_m + u * range_m, radial = unit(at_m);
    const Vec<Gcrs> a = unit(cross(radial, Vec<Gcrs>{0.6, 0.0, 0.8})), b = cross(radial, a);
    const Vec<Gcrs> v =
        (a * std::cos(t.course_rad) + b * std::sin(t.course_rad) + radial * t.radial_share) *
        std::sqrt(3.986004418e14 / norm(at_m));
    // A sphere of 1 m and albedo 0.2 at 1000 km and phase 90 deg has V = 6.67.
    const double radius_m = std::pow(10.0, 0.2 * (6.67 - t.magnitude)) * range_m / 1e6;
    char text[400];
    std::snprintf(text, sizeof text,
                  "- {name: t%zu, radius_m: %.6f, motion: {two_body: {position_m: [%.6f, %.6f, "
                  "%.6f], velocity_m_per_s: [%.9f, %.9f, %.9f]}}}\n",
                  i, radius_m, at_m.x, at_m.y, at_m.z, v.x, v.y, v.z);
    yaml += text;
  }
  return yaml;
}

}  // namespace dmise::test
