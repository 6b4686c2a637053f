#include "core/sky/variables/variable_stars.h"

#include <erfa.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <unordered_set>
#include <utility>

#include "core/base/files/text_file.h"
#include "core/base/units.h"
#include "core/sky/stars/star_merge.h"

namespace dmise {
namespace {

constexpr double heliocentric_day_s = 86400.0;
// By which a star that is the variable may be outside its range; brighter where that is not of V,
// which red stars are brighter in.
constexpr double outside_range_mag = 1.5, brighter_in_v_mag = 4.5;

/// A record and a star that may be one.
struct Pair {
  double apart_rad;
  std::size_t record;
  std::uint32_t place;

  bool operator<(const Pair& other) const {
    return std::tie(apart_rad, record, place) <
           std::tie(other.apart_rad, other.record, other.place);
  }
};

bool may_be(const VariableRecord& record, double v_mag) {
  if (!record.brightest_mag) return true;
  const double brighter_mag = record.band == "V" ? outside_range_mag : brighter_in_v_mag;
  return v_mag > *record.brightest_mag - brighter_mag &&
         v_mag < *record.brightest_mag + record.depth_mag.value_or(outside_range_mag) +
                     outside_range_mag;
}

std::vector<Pair> pairs_of(const StarMap& map, const VariableReading& reading) {
  const double years = 2000.0 - map.stars.epoch_jyear;
  const double radius_rad = same_star_rad + std::abs(years) * map.index.fastest_motion_rad_per_yr;
  std::vector<Pair> pairs;
  std::vector<std::uint32_t> near;
  for (std::size_t k = 0; k < reading.stars.size(); ++k) {
    const VariableRecord& record = reading.stars[k];
    const Vec<Gcrs> there = from_spherical<Gcrs>(record.ra_rad, record.dec_rad);
    near.clear();
    query_cone(map, there, radius_rad, std::numeric_limits<double>::infinity(), near);
    for (const std::uint32_t place : near) {
      const double apart_rad = angle_rad(there, direction_after(map, place, years));
      if (apart_rad <= same_star_rad && may_be(record, map.stars.v_mag[place]))
        pairs.push_back({apart_rad, k, place});
    }
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

bool pulsates(LightCurveShape shape) {
  return shape != LightCurveShape::constant && shape != LightCurveShape::separate_eclipses &&
         shape != LightCurveShape::touching_eclipses;
}

/// The curve of a record but for its level; constant where the record does not tell it.
StarLightCurve curve_of(const VariableRecord& record) {
  const LightCurveKind kind = light_curve_kind(record.type);
  if (!record.period_d || !record.epoch_hjd || !record.depth_mag || *record.depth_mag == 0.0)
    return {};
  StarLightCurve curve{.shape = kind.shape,
                       .depth_mag = *record.depth_mag,
                       .second_depth_mag = 0.0,
                       .share = record.share_of_period.value_or(kind.usual_share),
                       .epoch_hjd = *record.epoch_hjd,
                       .period_d = *record.period_d};
  if (kind.shape == LightCurveShape::separate_eclipses) {
    curve.second_depth_mag = std::min(record.second_depth_mag.value_or(0.0), curve.depth_mag);
    curve.share = std::min(curve.share, 0.5);
  } else if (kind.shape == LightCurveShape::touching_eclipses) {
    // Without a second depth the two are alike, as those of stars in contact are.
    curve.second_depth_mag =
        std::min(record.second_depth_mag.value_or(curve.depth_mag), curve.depth_mag);
  } else if (pulsates(kind.shape)) {
    curve.share = std::clamp(curve.share, 0.02, 0.98);
  }
  return curve;
}

VariableStars::Star star_of(const VariableRecord& record, std::uint32_t place, double v_mag) {
  VariableStars::Star star{
      .place = place, .name = record.name, .type = record.type, .curve = curve_of(record)};
  const bool in_v = record.band == "V" && record.brightest_mag;
  const double mean_fainter =
      star.varies() ? star.curve.mean_fainter_by_mag() : 0.5 * record.depth_mag.value_or(0.0);
  // In another band the range is that of the light curve, about the catalogue's mean.
  star.brightest_v_mag = in_v ? *record.brightest_mag : v_mag - mean_fainter;
  star.curve.brightest_v_mag = star.brightest_v_mag;
  star.mean_v_mag = star.brightest_v_mag + mean_fainter;
  star.faintest_v_mag = star.brightest_v_mag + record.depth_mag.value_or(0.0);
  if (!star.varies()) {  // whatever the record has, it has the catalogue's magnitude
    star.mean_v_mag = v_mag;
    star.brightest_v_mag = std::min(star.brightest_v_mag, v_mag);
    star.faintest_v_mag = std::max(star.faintest_v_mag, v_mag);
  }
  return star;
}

/// Appends variables of a cone that `query_cone` leaves out for their catalogue's magnitude, and
/// restores the order.
template <class Brightest>
void query_variables(const StarMap& map, const Vec<Gcrs>& axis, double radius_rad,
                     double faintest_v_mag, std::vector<std::uint32_t>& found,
                     const Brightest& brightest) {
  const std::size_t before = found.size();
  query_cone(map, axis, radius_rad, faintest_v_mag, found);
  if (!map.variables) return;
  const std::size_t catalogued = found.size();
  const double cosine = std::cos(std::min(radius_rad, pi));
  for (const VariableStars::Star& star : map.variables->stars())
    if (map.stars.v_mag[star.place] > faintest_v_mag && brightest(star) <= faintest_v_mag &&
        dot(map.index.direction[star.place], axis) >= cosine)
      found.push_back(star.place);
  if (found.size() > catalogued) std::sort(found.begin() + std::ptrdiff_t(before), found.end());
}

}  // namespace

double VariableTime::heliocentric_jd(const Vec<Gcrs>& direction) const {
  return jd_utc + dot(observer_from_sun_m, direction) / speed_of_light_m_per_s / heliocentric_day_s;
}

VariableTime variable_time(const Tt& tt, const Vec<Gcrs>& observer_from_sun_m) {
  double tai1 = 0.0, tai2 = 0.0, utc1 = 0.0, utc2 = 0.0;
  eraTttai(tt.jd1, tt.jd2, &tai1, &tai2);
  eraTaiutc(tai1, tai2, &utc1, &utc2);
  return {utc1 + utc2, observer_from_sun_m};
}

VariableStars::VariableStars(const StarMap& map, const VariableReading& reading)
    : records_(reading.stars.size()),
      problems_(reading.problems.size()),
      problem_(reading.problems.empty() ? "" : reading.problems.front()) {
  std::vector<bool> known(reading.stars.size(), false);
  std::unordered_set<std::uint32_t> taken;
  for (const Pair& pair : pairs_of(map, reading)) {
    if (known[pair.record] || !taken.insert(pair.place).second) continue;
    known[pair.record] = true;
    stars_.push_back(star_of(reading.stars[pair.record], pair.place, map.stars.v_mag[pair.place]));
  }
  std::ranges::sort(stars_, {}, &Star::place);
}

const VariableStars::Star* VariableStars::find(std::uint32_t place) const {
  const auto star = std::ranges::lower_bound(stars_, place, {}, &Star::place);
  return star != stars_.end() && star->place == place ? &*star : nullptr;
}

double VariableStars::v_mag(std::uint32_t place, double v_mag, const VariableTime& time,
                            const Vec<Gcrs>& direction) const {
  const Star* star = find(place);
  return star && star->varies() ? star->curve.v_mag(time.heliocentric_jd(direction)) : v_mag;
}

double VariableStars::brightest_v_mag(std::uint32_t place, double v_mag) const {
  const Star* star = find(place);
  return star && star->varies() ? std::min(v_mag, star->brightest_v_mag) : v_mag;
}

std::shared_ptr<const StarMap> with_variable_stars(const std::shared_ptr<const StarMap>& map,
                                                   const std::string& path) {
  const VariableReading reading = parse_gcvs(read_text_file(path), path);
  auto with = std::make_shared<StarMap>(*map);  // columns are shared
  with->variables = std::make_shared<const VariableStars>(*map, reading);
  return with;
}

void query_brightest(const StarMap& map, const Vec<Gcrs>& axis, double radius_rad,
                     double faintest_v_mag, std::vector<std::uint32_t>& found) {
  query_variables(
      map, axis, radius_rad, faintest_v_mag, found, [](const VariableStars::Star& star) {
        return star.varies() ? star.brightest_v_mag : std::numeric_limits<double>::infinity();
      });
}

void query_possible(const StarMap& map, const Vec<Gcrs>& axis, double radius_rad,
                    double faintest_v_mag, std::vector<std::uint32_t>& found) {
  query_variables(map, axis, radius_rad, faintest_v_mag, found,
                  [](const VariableStars::Star& star) { return star.brightest_v_mag; });
}

}  // namespace dmise
