#include "core/detection/known/catalogue_sky.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/units.h"
#include "core/detection/known/atmosphere.h"
#include "core/photometry/magnitude.h"
#include "core/sky/variables/variable_stars.h"
#include "core/time/clock.h"
#include "core/time/iso8601.h"
#include "core/time/julian_date.h"
#include "core/wcs/wcs.h"

namespace dmise {
namespace {

constexpr double missing_from_mag = 1.0;  // before the counts' fall shows that stars are missing

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

/// Sets the mean light and its range of a variable star that was expected at its brightest.
void set_range(const VariableStars::Star& variable, ExpectedStar& star) {
  star.most = light_of_magnitude(variable.brightest_v_mag - variable.mean_v_mag);
  star.least = light_of_magnitude(variable.faintest_v_mag - variable.mean_v_mag);
  star.signal_e /= star.most;
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
                                                 double min_signal_e, double beyond_px) const {
  if (!can_expect(header.unknown)) return {};
  const StarTable& stars = map_->stars;
  const ExpectedStars expected(header, columns, rows, min_signal_e, beyond_px);
  const Vec<Gcrs> axis = wcs_direction(header.wcs, {(columns - 1) / 2.0, (rows - 1) / 2.0});
  const Tt tt = Clock(parse_utc(header.middle_utc)).tt({});
  const double years = 2000.0 + julian_years_since_j2000(tt) - stars.epoch_jyear;
  std::vector<std::uint32_t> candidates;
  query_possible(*map_, axis,
                 reach_rad(header.wcs, axis, columns, rows, beyond_px) +
                     std::abs(years) * map_->index.fastest_motion_rad_per_yr,
                 expected.faintest_v_mag(), candidates);
  std::vector<ExpectedStar> out;
  for (const std::uint32_t i : candidates) {
    const auto* variable = map_->variables ? map_->variables->find(i) : nullptr;
    auto star =
        expected.at(direction_after(*map_, i, years),
                    variable ? variable->brightest_v_mag : double(stars.v_mag[i]), stars.colour(i));
    if (!star) continue;
    if (variable) set_range(*variable, *star);
    out.push_back(*star);
  }
  return out;
}

double complete_to_e(const CatalogueSky& sky, const FrameHeader& header, PixelPosition pixel) {
  return header.exposure_s *
         std::pow(10.0, 0.4 * (header.v_solar_zero_point_mag() - extinction_mag(header, pixel) -
                               sky.complete_to_v_mag()));
}

}  // namespace dmise
