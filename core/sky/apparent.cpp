#include "core/sky/apparent.h"

#include <erfa.h>

#include "core/base/error.h"
#include "core/effects/place_effects.h"

namespace dmise {
namespace {

constexpr double julian_year_s = 365.25 * day_s;
constexpr double light_years_per_au = au_m / speed_of_light_m_per_s / julian_year_s;

struct Array {
  double v[3];
  explicit Array(const Vec<Gcrs>& a) : v{a.x, a.y, a.z} {}
};
Vec<Gcrs> from_erfa(const double (&v)[3]) { return {v[0], v[1], v[2]}; }

double inverse_gamma(const Vec<Gcrs>& v_c) { return std::sqrt(1.0 - dot(v_c, v_c)); }

Vec<Gcrs> aberrated_by(const Vec<Gcrs>& direction, const Vec<Gcrs>& v_c, double sun_distance_au,
                       double gamma_inverse) {
  Array from(direction), v(v_c);
  double to[3];
  eraAb(from.v, v.v, sun_distance_au, gamma_inverse, to);
  return from_erfa(to);
}

}  // namespace

Observer ground_observer(const Site& site, const EarthOrientation& earth, SimTime t, const Tt& tt,
                         const SolarSystem& solar_system, const Refraction& refraction) {
  const Rotation<Gcrs, Itrs> gcrs_from_itrs = earth.itrs_from_gcrs(t).inverse();
  const Vec<Itrs> site_m = itrs_from_geodetic(site);
  const Vec<Gcrs> zenith = gcrs_from_itrs * (enu_from_itrs(site).inverse() * Vec<Enu>{0, 0, 1});
  return {.time = tt,
          .solar_system = solar_system,
          .position_m = gcrs_from_itrs * site_m,
          .velocity_m_per_s = earth.velocity_of_fixed_point(site_m, t),
          .air = Air{zenith, refraction}};
}

Observer space_observer(const Vec<Gcrs>& position_m, const Vec<Gcrs>& velocity_m_per_s,
                        const Tt& tt, const SolarSystem& solar_system) {
  return {.time = tt,
          .solar_system = solar_system,
          .position_m = position_m,
          .velocity_m_per_s = velocity_m_per_s};
}

ApparentPlaces::ApparentPlaces(const Observer& observer, const EffectSet& effects)
    : observer_(observer),
      proper_motion_(effects.has(effect::proper_motion)),
      parallax_(effects.has(effect::parallax)),
      deflection_(effects.has(effect::light_deflection)),
      light_time_(effects.has(effect::light_time)),
      refraction_(effects.has(effect::refraction) && observer.air.has_value()) {
  const SolarSystem& s = observer.solar_system;
  barycentric_au_ = (s.earth_barycentric_m + observer.position_m) / au_m;
  const Vec<Gcrs> from_sun_m = observer.position_m - s.sun_m;
  sun_distance_au_ = norm(from_sun_m) / au_m;
  from_sun_ = unit(from_sun_m);
  years_ = 2000.0 + julian_years_since_j2000(observer.time);

  const bool annual = effects.has(effect::annual_aberration);
  satellite_aberration_ = effects.has(effect::diurnal_aberration);
  star_aberration_ = annual || satellite_aberration_;
  if (satellite_aberration_)
    satellite_velocity_c_ = observer.velocity_m_per_s / speed_of_light_m_per_s;
  star_velocity_c_ = satellite_velocity_c_;
  if (annual) star_velocity_c_ += s.earth_velocity_m_per_s / speed_of_light_m_per_s;
  star_inverse_gamma_ = inverse_gamma(star_velocity_c_);
  satellite_inverse_gamma_ = inverse_gamma(satellite_velocity_c_);
}

Vec<Gcrs> ApparentPlaces::star(const StarPlace& star) const {
  const double sin_ra = std::sin(star.ra_rad), cos_ra = std::cos(star.ra_rad);
  const double sin_dec = std::sin(star.dec_rad), cos_dec = std::cos(star.dec_rad);
  const Vec<Gcrs> catalogue{cos_ra * cos_dec, sin_ra * cos_dec, sin_dec};
  Vec<Gcrs> p = catalogue;
  if (proper_motion_) {
    const Vec<Gcrs> east{-sin_ra, cos_ra, 0.0};
    const Vec<Gcrs> north{-cos_ra * sin_dec, -sin_ra * sin_dec, cos_dec};
    const double receding_per_yr =
        star.radial_velocity_m_per_s * (julian_year_s / au_m) * star.parallax_rad;
    // The light also has to come in from the star's side to the observer.
    const double years =
        years_ - star.epoch_jyear + dot(catalogue, barycentric_au_) * light_years_per_au;
    p += years * (star.pm_ra_cosdec_rad_per_yr * east + star.pm_dec_rad_per_yr * north +
                  receding_per_yr * catalogue);
  }
  if (parallax_) p = p - star.parallax_rad * barycentric_au_;
  p = bent_and_aberrated(unit(p));
  return refraction_ ? through_air(p, Refraction::star) : p;
}

Vec<Gcrs> ApparentPlaces::bent_and_aberrated(Vec<Gcrs> p) const {
  if (deflection_) {
    Array from(p), sun(from_sun_);
    double to[3];
    eraLdsun(from.v, sun.v, sun_distance_au_, to);
    p = from_erfa(to);
  }
  if (star_aberration_)
    p = aberrated_by(p, star_velocity_c_, sun_distance_au_, star_inverse_gamma_);
  return p;
}

Vec<Gcrs> ApparentPlaces::star_seen_at(const Vec<Gcrs>& apparent) const {
  Vec<Gcrs> above_air = unit(apparent);
  if (refraction_) {
    const Vec<Gcrs>& up = observer_.air->zenith;
    const double sine = dot(above_air, up);
    const Vec<Gcrs> level = above_air - up * sine;
    const double cosine = norm(level);
    if (cosine >= 1e-12) {
      const double elevation_rad =
          observer_.air->refraction.true_from_apparent_rad(std::atan2(sine, cosine));
      above_air = level * (std::cos(elevation_rad) / cosine) + up * std::sin(elevation_rad);
    }
  }
  // What is left falls by v/c each time.
  Vec<Gcrs> star = above_air;
  for (int i = 0; i < 8; ++i) {
    const Vec<Gcrs> missed = above_air - bent_and_aberrated(star);
    star = unit(star + missed);
    if (norm(missed) < 1e-12) break;
  }
  return star;
}

void ApparentPlaces::stars(const StarColumns& c, std::span<const std::uint32_t> which,
                           std::span<Vec<Gcrs>> directions) const {
  if (directions.size() != which.size()) throw Error("stars: one direction a star");
  const bool radial = !c.radial_velocity_m_per_s.empty();
  for (std::size_t k = 0; k < which.size(); ++k) {
    const std::uint32_t i = which[k];
    directions[k] = star({.ra_rad = c.ra_rad[i],
                          .dec_rad = c.dec_rad[i],
                          .pm_ra_cosdec_rad_per_yr = c.pm_ra_cosdec_rad_per_yr[i],
                          .pm_dec_rad_per_yr = c.pm_dec_rad_per_yr[i],
                          .parallax_rad = c.parallax_rad[i],
                          .radial_velocity_m_per_s = radial ? c.radial_velocity_m_per_s[i] : 0.0,
                          .epoch_jyear = c.epoch_jyear});
  }
}

void ApparentPlaces::finish(const Vec<Gcrs>& line_m, SatellitePlace& place) const {
  if (!(dot(line_m, line_m) > 0.0)) throw Error("no direction to a satellite at the observer");
  place.astrometric = unit(line_m);
  // The Sun's potential bends nothing over such distances, so it is put far away.
  place.aberrated = satellite_aberration_ ? aberrated_by(place.astrometric, satellite_velocity_c_,
                                                         1e9, satellite_inverse_gamma_)
                                          : place.astrometric;
  place.direction = refraction_ ? through_air(place.aberrated, norm(line_m)) : place.aberrated;
}

// Turns a direction towards the zenith.
Vec<Gcrs> ApparentPlaces::through_air(const Vec<Gcrs>& direction, double distance_m) const {
  const Vec<Gcrs>& up = observer_.air->zenith;
  const double sine = dot(direction, up);
  const Vec<Gcrs> level = direction - up * sine;
  const double cosine = norm(level);
  if (cosine < 1e-12) return direction;  // zenith or nadir: no side to bend to
  const auto seen = observer_.air->refraction.apparent_from_true({sine, cosine}, distance_m);
  return level * (seen.cosine / cosine) + up * seen.sine;
}

}  // namespace dmise
