#pragma once
#include <cstdint>
#include <optional>
#include <span>

#include "core/base/numeric/simd_level.h"
#include "core/effects/acting_effects.h"
#include "core/sky/places/observer.h"
#include "core/sky/places/place_effects.h"
#include "core/sky/places/star_place.h"

namespace dmise {

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

/// A planet, with the step on the way.
struct PlanetPlace {
  Vec<Gcrs> line_m;     // from the observer to where its light left
  Vec<Gcrs> direction;  // unit: as it comes into the camera
};

/// Apparent directions at a camera, in GCRS axes: `PlaceEffects` in their order, those that are
/// switched on. Constants of the observer are computed once. Immutable after construction.
class ApparentPlaces {
 public:
  ApparentPlaces(const Observer& observer, const EffectSet& effects);

  /// Returns the apparent direction of a star (unit), as ERFA's eraPmpx, eraLdsun and eraAb with
  /// the observer's place instead of the Earth's.
  Vec<Gcrs> star(const StarPlace& star) const;

  /// The two halves of `star`: the place of a star at the observer's time, and the apparent
  /// direction of a star at a place. Unit vectors.
  Vec<Gcrs> astrometric(const CataloguedStar& catalogued) const;
  Vec<Gcrs> seen(const Vec<Gcrs>& astrometric) const;

  /// The first half for many stars: `places[i]` of star `which[i]` of a catalogue without radial
  /// velocities. `directions`: of all its stars at its epoch (unit). Equal to 1e-15 rad.
  void astrometric(const StarColumns& catalogue, std::span<const std::uint32_t> which,
                   std::span<const Vec<Gcrs>> directions, std::span<Vec<Gcrs>> places,
                   SimdLevel level = best_simd_level()) const;

  /// Returns the place of a star without parallax and proper motion that is seen in an apparent
  /// direction: the inverse of `star`, to 1e-12 rad. Unit vector.
  Vec<Gcrs> star_seen_at(const Vec<Gcrs>& apparent) const;

  /// `directions[i]` of star `which[i]` of a catalogue.
  void stars(const StarColumns& catalogue, std::span<const std::uint32_t> which,
             std::span<Vec<Gcrs>> directions) const;

  /// `position_at(dt_s)`: the satellite's GCRS position [m] at the observer's time + dt_s, for dt_s
  /// = 0 and about a light time before. A satellite shares the Earth's motion: aberration is by the
  /// observer's geocentric velocity alone. Throws `Error` for a satellite at the observer.
  template <class PositionAt>
  SatellitePlace satellite(PositionAt&& position_at) const {
    const auto line_m = [&](double dt_s) { return position_at(dt_s) - observer_m_; };
    const Vec<Gcrs> now_m = line_m(0.0);
    SatellitePlace place{.range_m = norm(now_m)};
    const auto* light_time = effects_.find<LightTime>();
    finish(light_time ? light_time->apply(line_m, now_m, place.light_time_s) : now_m, place);
    return place;
  }

  /// Place on a straight path at the observer's time: exact to 3 mm from LEO to GEO.
  SatellitePlace satellite(const Vec<Gcrs>& position_m, const Vec<Gcrs>& slope_m_per_s) const {
    return satellite([&](double dt_s) { return position_m + slope_m_per_s * dt_s; });
  }

  /// `line_m(dt_s)`: from the observer now to a planet at now + dt_s, for dt_s = 0 and about a
  /// light time before. The Earth's motion displaces it as it does stars, and the Sun bends its
  /// light as theirs.
  template <class Line>
  PlanetPlace planet(Line&& line_m) const {
    const Vec<Gcrs> now_m = line_m(0.0);
    double light_time_s = 0.0;
    const auto* light_time = effects_.find<LightTime>();
    const Vec<Gcrs> came_m = light_time ? light_time->apply(line_m, now_m, light_time_s) : now_m;
    return {came_m, seen(unit(came_m))};
  }

 private:
  Vec<Gcrs> bent_and_aberrated(Vec<Gcrs> direction) const;
  void finish(const Vec<Gcrs>& line_m, SatellitePlace& place) const;

  Vec<Gcrs> observer_m_;  // geocentric
  ActingEffects<PlaceEffects> effects_;
  std::optional<Aberration> of_stars_, of_satellites_;
};

}  // namespace dmise
