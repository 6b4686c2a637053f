#pragma once
#include "core/frames/earth_orientation.h"
#include "sensors/observatory/site_sky.h"

namespace dmise {

/// A sphere of stars that turns evenly about the pole, without air and aberration.
struct TurningSky : SiteSky {
  Site site{40.0, 0.0, 0.0};

  double angle_rad(SimTime t) const { return 1.0 + earth_turn_rad_per_s * t.seconds(); }
  Rotation<Itrs, Gcrs> itrs_from_gcrs(SimTime t) const {
    const double c = std::cos(angle_rad(t)), s = std::sin(angle_rad(t));
    Rotation<Itrs, Gcrs> r;
    r.m = {{{c, s, 0}, {-s, c, 0}, {0, 0, 1}}};
    return r;
  }
  Rotation<Enu, Gcrs> enu_from_gcrs(SimTime t) const {
    return enu_from_itrs(site) * itrs_from_gcrs(t);
  }
  Vec<Enu> seen(const Equatorial& icrs, SimTime t) const override {
    return enu_from_gcrs(t) * direction_of<Gcrs>(icrs);
  }
  Equatorial star_seen_at(const Vec<Enu>& direction, SimTime t) const override {
    return equatorial_of(gcrs(direction, t));
  }
  Vec<Gcrs> gcrs(const Vec<Enu>& direction, SimTime t) const override {
    return enu_from_gcrs(t).inverse() * direction;
  }
  double sidereal_time_rad(SimTime t) const override { return std::fmod(angle_rad(t), 2 * pi); }
};

/// A place of that sky by its hour angle at a time.
inline Equatorial at_hour_angle(const TurningSky& sky, double hour_angle_deg, double dec_deg,
                                SimTime t) {
  const double ra_deg = sky.angle_rad(t) / deg - hour_angle_deg;
  return {std::fmod(ra_deg + 720.0, 360.0), dec_deg};
}

}  // namespace dmise
