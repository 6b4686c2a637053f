#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>

#include "core/base/units.h"
#include "core/effects/effects.h"
#include "core/frames/earth_orientation.h"
#include "core/frames/geodesy.h"
#include "core/sky/refraction.h"
#include "core/sky/sun_moon.h"

namespace dmise {

/// The air over a ground observer.
struct Air {
  Vec<Gcrs> zenith;  // unit, normal of the ellipsoid
  Refraction refraction;
};

/// A camera at one instant.
struct Observer {
  Tt time;
  SolarSystem solar_system;
  Vec<Gcrs> position_m;        // geocentric
  Vec<Gcrs> velocity_m_per_s;  // geocentric
  std::optional<Air> air;      // none in space
};

Observer ground_observer(const Site& site, const EarthOrientation& earth, SimTime t, const Tt& tt,
                         const SolarSystem& solar_system, const Refraction& refraction);
Observer space_observer(const Vec<Gcrs>& position_m, const Vec<Gcrs>& velocity_m_per_s,
                        const Tt& tt, const SolarSystem& solar_system);

/// A star as a catalogue gives it, ICRS, at `epoch_jyear`.
struct StarPlace {
  double ra_rad = 0.0;
  double dec_rad = 0.0;
  double pm_ra_cosdec_rad_per_yr = 0.0;  // on the sky, so finite at the poles
  double pm_dec_rad_per_yr = 0.0;
  double parallax_rad = 0.0;
  double radial_velocity_m_per_s = 0.0;  // receding is positive
  double epoch_jyear = 2000.0;           // Julian year, TT
};

/// Columns of a catalogue, for batches: all of one length, `radial_velocity_m_per_s` may be empty.
struct StarColumns {
  double epoch_jyear = 2000.0;
  std::span<const double> ra_rad, dec_rad, pm_ra_cosdec_rad_per_yr, pm_dec_rad_per_yr, parallax_rad,
      radial_velocity_m_per_s;
};

/// One Earth satellite, with the steps on the way.
struct SatellitePlace {
  Vec<Gcrs> astrometric;      // unit: from the observer to where its light left
  Vec<Gcrs> aberrated;        // unit: as its light meets the moving observer, above any air
  Vec<Gcrs> direction;        // unit: as it comes into the camera
  double range_m = 0.0;       // geometric, both at the observer's time
  double light_time_s = 0.0;  // 0 when switched off
};

/// Apparent directions at a camera, in GCRS axes: what an observer constant costs is paid once.
/// Each correction runs when `effects` has it: proper_motion, parallax, light_deflection,
/// annual_aberration, diurnal_aberration, light_time, refraction. Immutable after construction.
class ApparentPlaces {
 public:
  ApparentPlaces(const Observer& observer, const EffectSet& effects);

  /// Unit vector. As ERFA: eraPmpx with the Earth's place replaced by the observer's, eraLdsun,
  /// eraAb.
  Vec<Gcrs> star(const StarPlace& star) const;

  /// Where a star without parallax and proper motion stands that is seen at an apparent direction:
  /// the inverse of `star`, to 1e-12 rad. A unit vector.
  Vec<Gcrs> star_seen_at(const Vec<Gcrs>& apparent) const;

  /// `directions[i]` of star `which[i]` of a catalogue.
  void stars(const StarColumns& catalogue, std::span<const std::uint32_t> which,
             std::span<Vec<Gcrs>> directions) const;

  /// `position_at(dt_s)`: the satellite's GCRS position [m] at the observer's time + dt_s, asked
  /// for 0 and for one light time before. It shares the Earth's motion: aberration is by the
  /// observer's geocentric velocity alone. Throws `Error` for a satellite at the observer.
  template <class PositionAt>
  SatellitePlace satellite(PositionAt&& position_at) const {
    const Vec<Gcrs> now_m = position_at(0.0) - observer_.position_m;
    SatellitePlace place{.range_m = norm(now_m)};
    Vec<Gcrs> then_m = now_m;
    if (light_time_) {
      // Each turn gains a factor v/c: three end below a picosecond.
      for (int i = 0; i < 3; ++i) {
        place.light_time_s = norm(then_m) / speed_of_light_m_per_s;
        then_m = position_at(-place.light_time_s) - observer_.position_m;
      }
    }
    finish(then_m, place);
    return place;
  }

  /// The same for a straight path at the observer's time: exact to 3 mm from LEO to GEO.
  SatellitePlace satellite(const Vec<Gcrs>& position_m, const Vec<Gcrs>& slope_m_per_s) const {
    return satellite([&](double dt_s) { return position_m + slope_m_per_s * dt_s; });
  }

 private:
  Vec<Gcrs> bent_and_aberrated(Vec<Gcrs> p) const;
  Vec<Gcrs> through_air(const Vec<Gcrs>& direction, double distance_m) const;
  void finish(const Vec<Gcrs>& line_m, SatellitePlace& place) const;

  Observer observer_;
  Vec<Gcrs> barycentric_au_;
  Vec<Gcrs> from_sun_;  // unit
  double sun_distance_au_ = 1.0;
  double years_ = 0.0;              // of `time`, Julian year
  Vec<Gcrs> star_velocity_c_;       // that aberrates stars, in units of light's
  Vec<Gcrs> satellite_velocity_c_;  // that aberrates satellites
  double star_inverse_gamma_ = 1.0;
  double satellite_inverse_gamma_ = 1.0;
  bool proper_motion_, parallax_, deflection_, star_aberration_, satellite_aberration_, light_time_,
      refraction_;
};

}  // namespace dmise
