#pragma once
#include <vector>

#include "core/frames/oblate_earth.h"
#include "core/sky/bodies/shadow.h"
#include "core/sky/places/sun_moon.h"
#include "core/time/clock.h"

namespace dmise {

/// Earth, Sun and Moon over a span of time, computed once an hour; the result depends on the
/// instant alone. Precession and nutation are constant over the hour (4 mas at its ends), the Sun
/// moves linearly (0.02 arcsec), the Moon along a parabola (10 m). Immutable.
class EphemerisTable {
 public:
  /// For instants in [from, to]; `ellipsoid` casts the shadow.
  EphemerisTable(const Clock& clock, SimTime from, SimTime to, const Ellipsoid& ellipsoid = wgs84);

  const Clock& clock() const { return clock_; }
  const EarthOrientation& earth(SimTime t) const { return hour(t).earth; }
  OblateEarth surface(SimTime t) const { return oblate_earth(earth(t), ellipsoid_); }
  Vec<Gcrs> sun_m(SimTime t) const;
  Vec<Gcrs> moon_m(SimTime t) const;

 private:
  struct Hour {
    SimTime start;
    EarthOrientation earth;
    Vec<Gcrs> sun_m, sun_step_m;  // at its start, and from there to its end
    Vec<Gcrs> moon_m, moon_step_m,
        bend_m;  // as those of the Sun; by the share of the hour and its square
  };
  const Hour& hour(SimTime t) const;

  Clock clock_;
  Ellipsoid ellipsoid_;
  std::vector<Hour> hours_;
};

/// Minimum fraction of the Sun's disc for an object to count as sunlit.
inline constexpr double lit_fraction = 0.5;

/// Sunlight at one instant, for states from SGP4.
class Sunlight {
 public:
  Sunlight(const EphemerisTable& sky, SimTime t);

  /// Fraction of the Sun's disc visible past the oblate Earth, 0..1; 0 inside the Earth.
  double fraction(const Vec<Teme>& position_m) const;
  const Vec<Gcrs>& sun_m() const { return sun_m_; }
  const Rotation<Gcrs, Teme>& gcrs_from_teme() const { return gcrs_from_teme_; }

 private:
  Rotation<Gcrs, Teme> gcrs_from_teme_;
  Vec<Gcrs> sun_m_;
  EarthShadow shadow_;
};

}  // namespace dmise
