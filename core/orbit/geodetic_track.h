#pragma once
#include <string>
#include <string_view>

#include "core/frames/geodesy.h"
#include "core/orbit/oem.h"

namespace dmise {

/// Parses a track of something that moves over the Earth (a balloon, an aircraft, a lamp on a
/// drone) from CSV with the header `time_s,latitude_deg,longitude_deg,height_m`: seconds since
/// `start`, increasing, and geodetic coordinates on `ellipsoid`. Positions are joined in ITRS by
/// cubic Hermite polynomials whose slopes are those of the parabola through each point and its
/// neighbours. `name`: the object's. Throws `ConfigError` `source:line: reason, got "value"`.
Trajectory parse_geodetic_track(std::string_view text, const std::string& source, const Tai& start,
                                const std::string& name, const Ellipsoid& ellipsoid = wgs84);

/// Reads a track of a file, optionally gzipped.
Trajectory read_geodetic_track(const std::string& path, const Tai& start, const std::string& name,
                               const Ellipsoid& ellipsoid = wgs84);

/// Reads a track of a file with the header `time_s,east_m,north_m,up_m`: relative to `origin` and
/// on its axes.
Trajectory read_enu_track(const std::string& path, const Tai& start, const std::string& name,
                          const Site& origin);

}  // namespace dmise
