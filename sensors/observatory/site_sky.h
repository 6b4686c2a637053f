#pragma once
#include "core/base/sim_time.h"
#include "core/base/units.h"
#include "core/frames/geodesy.h"
#include "core/frames/vec.h"

namespace dmise {

/// A place among the stars: ICRS, at infinity.
struct Equatorial {
  double ra_deg = 0.0;   // [0, 360)
  double dec_deg = 0.0;  // [-90, 90]

  bool operator==(const Equatorial&) const = default;
};

/// Returns the unit vector of a place.
template <class F>
Vec<F> direction_of(const Equatorial& place) {
  const double ra = place.ra_deg * deg, dec = place.dec_deg * deg;
  return {std::cos(dec) * std::cos(ra), std::cos(dec) * std::sin(ra), std::sin(dec)};
}

/// Returns the place of a direction of any length > 0.
template <class F>
Equatorial equatorial_of(const Vec<F>& v) {
  const double ra_deg = std::atan2(v.y, v.x) / deg;
  const double dec_deg = std::atan2(v.z, std::hypot(v.x, v.y)) / deg;
  return {ra_deg < 0.0 ? std::fmod(ra_deg + 360.0, 360.0) : ra_deg, dec_deg};
}

/// Returns the unit vector towards an azimuth and elevation.
inline Vec<Enu> direction_of(const Horizontal& h) {
  const double ce = std::cos(h.elevation_rad);
  return {ce * std::sin(h.azimuth_rad), ce * std::cos(h.azimuth_rad), std::sin(h.elevation_rad)};
}

/// The sky over a site: where in it light of the stars comes from. Directions are unit vectors.
class SiteSky {
 public:
  virtual ~SiteSky() = default;

  /// Where a star at an ICRS place is seen at `t`, with aberration and refraction.
  virtual Vec<Enu> seen(const Equatorial& icrs, SimTime t) const = 0;
  /// The place of a star that is seen in a direction: the inverse of `seen`.
  virtual Equatorial star_seen_at(const Vec<Enu>& direction, SimTime t) const = 0;
  /// A direction in axes of the stars.
  virtual Vec<Gcrs> gcrs(const Vec<Enu>& direction, SimTime t) const = 0;
  /// Local apparent sidereal time [rad, 0..2 pi).
  virtual double sidereal_time_rad(SimTime t) const = 0;
};

/// The celestial pole of a site at a latitude, without polar motion (0.5 arcsec).
inline Vec<Enu> pole_of(double latitude_deg) {
  return {0.0, std::cos(latitude_deg * deg), std::sin(latitude_deg * deg)};
}

/// Hour angle of a direction [rad, -pi..pi], west positive.
inline double hour_angle_rad(const Vec<Enu>& d, double latitude_deg) {
  const double s = std::sin(latitude_deg * deg), c = std::cos(latitude_deg * deg);
  return std::atan2(-d.x, d.z * c - d.y * s);
}

}  // namespace dmise
