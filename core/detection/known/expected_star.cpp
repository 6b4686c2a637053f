#include "core/detection/known/expected_star.h"

#include <algorithm>
#include <cmath>

#include "core/detection/known/atmosphere.h"
#include "core/sky/air/airmass.h"
#include "core/sky/bodies/planets.h"
#include "core/sky/places/light_time.h"
#include "core/time/clock.h"
#include "core/time/iso8601.h"
#include "core/wcs/wcs.h"

namespace dmise {
namespace {

constexpr double sunlike_bv = 0.65;  // the zero point is for a star of this colour

}  // namespace

ExpectedStars::ExpectedStars(const FrameHeader& header, int columns, int rows, double min_signal_e,
                             double beyond_px)
    : header_(header),
      columns_(columns),
      rows_(rows),
      min_signal_e_(min_signal_e),
      beyond_px_(beyond_px),
      light_(header.band),
      sunlike_(light_.photons_per_s_m2(0.0, sunlike_bv)),
      zenith_(zenith_of(header)),
      refraction_(refraction_of(header)) {}

double ExpectedStars::faintest_v_mag() const {
  const double brightest_colour = light_.max_photons_per_s_m2(0.0) / sunlike_;
  return header_.v_solar_zero_point_mag() -
         2.5 * std::log10(min_signal_e_ / (header_.exposure_s * brightest_colour));
}

std::optional<ExpectedStar> ExpectedStars::at(const Vec<Gcrs>& direction, double v_mag,
                                              const StarColour& colour) const {
  double extinction_mag = 0.0;
  if (header_.site) {
    double elevation_rad = std::asin(std::clamp(dot(direction, zenith_), -1.0, 1.0));
    if (refraction_) elevation_rad = refraction_->apparent_from_true_rad(elevation_rad);
    if (elevation_rad < 0.0) return std::nullopt;
    extinction_mag = header_.extinction_mag_per_airmass * airmass(elevation_rad);
  }
  const double of_colour = light_.photons_per_s_m2(0.0, colour) / sunlike_;
  const double signal_e =
      header_.exposure_s * of_colour *
      std::pow(10.0, 0.4 * (header_.v_solar_zero_point_mag() - extinction_mag - v_mag));
  if (!(signal_e >= min_signal_e_)) return std::nullopt;
  const auto place = wcs_pixel(header_.wcs, direction);
  if (!place || !(place->x_px > -beyond_px_ && place->y_px > -beyond_px_ &&
                  place->x_px < columns_ - 1 + beyond_px_ && place->y_px < rows_ - 1 + beyond_px_))
    return std::nullopt;
  return ExpectedStar{*place, signal_e};
}

std::vector<ExpectedStar> ExpectedStars::planets() const {
  const Tt tt = Clock(parse_utc(header_.middle_utc)).tt({});
  if (!ephemeris_covers(tt)) return {};
  const SolarSystem bodies = solar_system(tt);
  const Vec<Gcrs>& observer_m = header_.sensor_position_m;
  const double scale_rad_per_px = wcs_scale_rad_per_px(header_.wcs);
  std::vector<ExpectedStar> planets;
  for (const Planet planet : all_planets) {
    const auto line_at = [&](double dt_s) {
      return planet_line_m(planet, tt, bodies, observer_m, dt_s);
    };
    double light_time_s = 0.0;
    const Vec<Gcrs> line_m = LightTime{}.apply(line_at, line_at(0.0), light_time_s);
    const Vec<Gcrs> from_sun_m = line_m + observer_m - bodies.sun_m;
    auto seen = at(photocentre(planet, unit(line_m), from_sun_m, line_m),
                   planet_v_mag(planet, from_sun_m, line_m, tt), facts_of(planet).bv);
    if (!seen) continue;
    seen->radius_px = facts_of(planet).radius_m / norm(line_m) / scale_rad_per_px;
    planets.push_back(*seen);
  }
  return planets;
}

}  // namespace dmise
