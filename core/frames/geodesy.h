#pragma once
#include "core/base/units.h"
#include "core/frames/vec.h"

namespace dmise {

/// Ellipsoid of revolution, flattened at the poles.
struct Ellipsoid {
  double equatorial_radius_m = 6378137.0;  // WGS 84 (NIMA TR8350.2)
  double flattening = 1 / 298.257223563;   // [0, 1)

  double polar_radius_m() const { return equatorial_radius_m * (1 - flattening); }
  bool operator==(const Ellipsoid&) const = default;
};

inline constexpr Ellipsoid wgs84{};
inline constexpr Ellipsoid grs80{6378137.0, 1 / 298.257222101};
inline constexpr Ellipsoid wgs72{6378135.0, 1 / 298.26};

/// Geodetic coordinates; height above the ellipsoid.
struct Site {
  double latitude_deg = 0.0;   // [-90, 90]
  double longitude_deg = 0.0;  // east; any turn
  double height_m = 0.0;
  Ellipsoid ellipsoid = wgs84;

  bool operator==(const Site&) const = default;
};

/// Direction relative to a site's horizon.
struct Horizontal {
  double azimuth_rad = 0.0;    // from north through east, [0, 2 pi)
  double elevation_rad = 0.0;  // [-pi/2, pi/2]
};

/// Computed by GeographicLib. Throws `Error` for a latitude beyond the poles or numbers that are
/// not finite.
Vec<Itrs> itrs_from_geodetic(const Site& site);

/// The inverse: round trip within 1e-8 m to 2000 km of height, 5e-8 m at GEO (Karney).
/// Longitude in [-180, 180]; at the Earth's centre latitude 90.
Site geodetic_from_itrs(const Vec<Itrs>& position_m, const Ellipsoid& ellipsoid = wgs84);

/// Axes at a site: up is the normal of its ellipsoid. At a pole, longitude says where east is.
Rotation<Enu, Itrs> enu_from_itrs(const Site& site);

/// Azimuth and elevation of a vector of any length > 0. Azimuth at the zenith is 0.
Horizontal horizontal(const Vec<Enu>& v);

}  // namespace dmise
