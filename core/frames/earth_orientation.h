#pragma once
#include "core/base/sim_time.h"
#include "core/frames/vec.h"
#include "core/time/clock.h"

namespace dmise {

struct Cirs {};  // celestial intermediate: GCRS turned to the CIP of date, x axis at the CIO
struct Tirs {};  // terrestrial intermediate: CIRS turned by the Earth rotation angle

/// Rate of the Earth rotation angle (IERS 2010, equation 5.15) [rad/s of UT1].
inline constexpr double earth_turn_rad_per_s = 7.292115146706979e-5;

/// Orientation of the Earth around one instant. Precession, nutation and polar motion are frozen at
/// `time` and the rotation angles advance from there; the error of the frozen part grows by less
/// than 2 microarcseconds a second (0.12 mas in a minute). Plain data: the environment node
/// publishes it.
struct EarthOrientation {
  SimTime time;
  Rotation<Cirs, Gcrs> cirs_from_gcrs;  // IAU 2006/2000A (or 2000B) bias-precession-nutation
  Rotation<Itrs, Tirs> itrs_from_tirs;  // polar motion and TIO locator s'
  double era_rad = 0.0;                 // Earth rotation angle at `time`, [0, 2 pi)
  double era_rate_rad_per_s = earth_turn_rad_per_s;
  double gmst82_rad = 0.0;  // Greenwich mean sidereal time, IAU 1982, at `time`
  double gmst82_rate_rad_per_s = 7.292115855306587e-5;

  /// Moves `time` to `t`, and the angles with it.
  void run_on(SimTime t);
  Rotation<Itrs, Gcrs> itrs_from_gcrs(SimTime t) const;
  /// By GMST-82 and polar motion, without the equation of the equinoxes (AIAA 2006-6753).
  Rotation<Itrs, Teme> itrs_from_teme(SimTime t) const;
  Rotation<Gcrs, Teme> gcrs_from_teme(SimTime t) const;
  /// Velocity in GCRS [m/s] of a point fixed to the Earth at `itrs_m` [m].
  Vec<Gcrs> velocity_of_fixed_point(const Vec<Itrs>& itrs_m, SimTime t) const;

  bool operator==(const EarthOrientation&) const = default;
};

/// Precession-nutation series, in order of decreasing accuracy and cost.
enum class Nutation {
  iau2006_2000a,  // 1365 terms; the celestial pole to 0.3 mas (free core nutation left out)
  iau2000b,       // 77 terms; within 1 mas of the full series, 1995 to 2050
};

/// Returns the orientation at `time`; `tt` and `ut1` must be the same instant.
EarthOrientation earth_orientation(SimTime time, const Tt& tt, const Ut1& ut1,
                                   double polar_motion_x_rad, double polar_motion_y_rad,
                                   Nutation nutation = Nutation::iau2006_2000a);

EarthOrientation earth_orientation(const Clock& clock, SimTime time,
                                   Nutation nutation = Nutation::iau2006_2000a);

}  // namespace dmise
