#include "core/detection/catalogue_sky.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/units.h"
#include "core/detection/atmosphere.h"
#include "core/photometry/star_light.h"
#include "core/sky/airmass.h"
#include "core/time/clock.h"
#include "core/time/iso8601.h"
#include "core/time/julian_date.h"
#include "core/wcs/wcs.h"

namespace dmise {
namespace {

constexpr double missing_from_mag = 1.0;  // before the counts' fall shows that stars are missing
constexpr double sunlike_bv = 0.65;       // of what the zero point is for

/// Angle from an axis to the farthest place on the frame's edge that images sky.
double reach_rad(const Wcs& wcs, const Vec<Gcrs>& axis, int columns, int rows, double beyond_px) {
  constexpr int steps = 16;
  double least = 1.0;
  for (int i = 0; i <= steps; ++i) {
    const double x = double(columns - 1) * i / steps, y = double(rows - 1) * i / steps;
    for (const PixelPosition at : {PixelPosition{x, 0.0}, PixelPosition{x, double(rows - 1)},
                                   PixelPosition{0.0, y}, PixelPosition{double(columns - 1), y}})
      least = std::min(least, dot(wcs_direction(wcs, at), axis));
  }
  const double margin = beyond_px * wcs_scale_rad_per_px(wcs) + 0.02;
  return std::min(pi, std::acos(std::clamp(least, -1.0, 1.0)) * 1.02 + margin);
}

}  // namespace

CatalogueSky::CatalogueSky(std::shared_ptr<const StarMap> map) : map_(std::move(map)) {
  complete_to_v_mag_ = map_->summary.faintest_filled_v_mag - missing_from_mag;
}

bool CatalogueSky::can_expect(const UnknownFacts& unknown) {
  using enum FrameFact;
  return std::ranges::none_of(std::array{time, exposure, pointing, focal_length, zero_point},
                              [&](FrameFact fact) { return unknown.has(fact); });
}

std::vector<ExpectedStar> CatalogueSky::stars_in(const FrameHeader& header, int columns, int rows,
                                                 double least_signal_e, double beyond_px) const {
  if (!can_expect(header.unknown)) return {};
  const StarTable& stars = map_->stars;
  const StarLight light(header.band);
  const double sunlike = light.photons_per_s_m2(0.0, sunlike_bv);
  const double brightest_colour = light.most_photons_per_s_m2(0.0) / sunlike;
  const double faintest_v_mag =
      header.v_solar_zero_point_mag() -
      2.5 * std::log10(least_signal_e / (header.exposure_s * brightest_colour));
  const Vec<Gcrs> axis = wcs_direction(header.wcs, {(columns - 1) / 2.0, (rows - 1) / 2.0});
  const Tt tt = Clock(parse_utc(header.middle_utc)).tt({});
  const double years = 2000.0 + julian_years_since_j2000(tt) - stars.epoch_jyear;
  std::vector<std::uint32_t> candidates;
  query_cone(*map_, axis,
             reach_rad(header.wcs, axis, columns, rows, beyond_px) +
                 std::abs(years) * map_->index.fastest_motion_rad_per_yr,
             faintest_v_mag, candidates);
  const Vec<Gcrs> zenith = zenith_of(header);
  const auto refraction = refraction_of(header);
  std::vector<ExpectedStar> out;
  for (const std::uint32_t i : candidates) {
    const Vec<Gcrs> direction = direction_after(*map_, i, years);
    double extinction_mag = 0.0;
    if (header.site) {
      double elevation_rad = std::asin(std::clamp(dot(direction, zenith), -1.0, 1.0));
      if (refraction) elevation_rad = refraction->apparent_from_true_rad(elevation_rad);
      if (elevation_rad < 0.0) continue;
      extinction_mag = header.extinction_mag_per_airmass * airmass(elevation_rad);
    }
    const double colour = light.photons_per_s_m2(0.0, stars.colour(i)) / sunlike;
    const double signal_e =
        header.exposure_s * colour *
        std::pow(10.0, 0.4 * (header.v_solar_zero_point_mag() - extinction_mag - stars.v_mag[i]));
    if (!(signal_e >= least_signal_e)) continue;
    const auto place = wcs_pixel(header.wcs, direction);
    if (!place || !(place->x_px > -beyond_px && place->y_px > -beyond_px &&
                    place->x_px < columns - 1 + beyond_px && place->y_px < rows - 1 + beyond_px))
      continue;
    out.push_back({*place, signal_e});
  }
  return out;
}

double complete_to_e(const CatalogueSky& sky, const FrameHeader& header, PixelPosition pixel) {
  return header.exposure_s *
         std::pow(10.0, 0.4 * (header.v_solar_zero_point_mag() - extinction_mag(header, pixel) -
                               sky.complete_to_v_mag()));
}

}  // namespace dmise
