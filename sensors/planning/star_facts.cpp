#include "sensors/planning/star_facts.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/config/sensors/effect_list.h"
#include "core/effects/frame_effects.h"
#include "core/photometry/magnitude.h"
#include "core/sky/places/aberration.h"
#include "core/sky/stars/star_counts.h"
#include "core/sky/variables/variable_stars.h"
#include "sensors/planning/sky_facts.h"
#include "sensors/scene/throughput.h"

namespace dmise {
namespace {

/// In wider fields stars are not counted one by one: they are taken as spread over the sky.
constexpr double widest_counted_rad = 12.0 * deg;
/// By which places of a catalogue and apparent ones differ, but for refraction.
constexpr double displaced_rad = 0.03 * deg;
/// Stars are searched for so much farther than the field reaches.
constexpr double searched_rad = 1.3 * deg;
constexpr double aberration_constant_rad = 20.8 / 3600.0 * deg;  // at perihelion

/// Largest sine of the angle to `axis` of directions within `half_rad` of `boresight`.
double largest_sine(const Vec<Gcrs>& axis, const Vec<Gcrs>& boresight, double half_rad) {
  const double angle = angle_rad(axis, boresight);
  const double least = std::max(0.0, angle - half_rad), most = std::min(pi, angle + half_rad);
  if (least <= pi / 2 && most >= pi / 2) return 1.0;
  return std::max(std::sin(least), std::sin(most));
}

/// The brightest that a star is drawn.
double brightest_v_mag(const StarMap& map, std::uint32_t star) {
  const double v_mag = map.stars.v_mag[star];
  return map.variables ? map.variables->brightest_v_mag(star, v_mag) : v_mag;
}

/// Share of the sky within `radius_rad` of a direction.
double share_of_sky(double radius_rad) { return 0.5 * (1.0 - std::cos(std::min(radius_rad, pi))); }

}  // namespace

void StarFacts::ByLimit::add(double v_mag, double photons, double stars) {
  const auto first = std::size_t(std::clamp(std::ceil(v_mag), 0.0, double(star_limits) - 1.0));
  count[first] += stars;
  brightest = std::max(brightest, photons);
  if (first > 0) beyond[first - 1] = std::max(beyond[first - 1], photons);
}

void StarFacts::ByLimit::sum_up() {
  for (std::size_t m = 1; m < count.size(); ++m) count[m] += count[m - 1];
  for (std::size_t m = beyond.size() - 1; m > 0; --m)
    beyond[m - 1] = std::max(beyond[m - 1], beyond[m]);
}

StarFacts::StarFacts(const SensorConfig& sensor, const StarMap* stars, double faintest_v_mag)
    : stars_(stars), faintest_v_mag_(faintest_v_mag), light_(sensor.camera.band) {
  if (!stars) return;
  const StarTable& table = stars->stars;
  if (sensor.effects.has(StarBackground::facts))
    drawn_.to_v_mag = std::min(faintest_v_mag, stars->summary.faintest_filled_v_mag);
  if (drawn_.to_v_mag > -unbounded && sensor.effects.has(SyntheticBackground::facts)) {
    // The catalogue outlives this.
    field_.emplace(sensor, std::shared_ptr<const StarMap>(std::shared_ptr<void>(), stars),
                   faintest_v_mag);
    if (field_->synthetic()) drawn_ = {field_->synthetic()->to_v_mag(), true};
  }
  if (!stars->is_small()) {
    sum_up(*stars);
    return;
  }
  for (std::size_t i = 0; i < table.v_mag.size(); ++i) {
    const double v_mag = brightest_v_mag(*stars, std::uint32_t(i));
    if (v_mag > faintest_v_mag) continue;
    whole_sky_.add(v_mag, light_.photons_per_s_m2(v_mag, table.colour(i)));
    fastest_rad_per_yr_ = std::max(fastest_rad_per_yr_, std::hypot(table.pm_ra_cosdec_rad_per_yr[i],
                                                                   table.pm_dec_rad_per_yr[i]));
    largest_parallax_rad_ = std::max(largest_parallax_rad_, double(table.parallax_rad[i]));
  }
  whole_sky_.sum_up();
  if (stars->file) stars->file->release();  // the columns that only this has read
}

/// A star may be as bright in the band as any of its magnitude.
void StarFacts::sum_up(const StarMap& map) {
  const StarSummary& stars = map.summary;
  const double brightest_colour = light_.max_photons_per_s_m2(0.0);
  for (std::size_t bin = 0; bin < StarSummary::bins; ++bin) {
    const double v_mag = StarSummary::bright_edge(bin);
    if (stars.count[bin] == 0 || v_mag > faintest_v_mag_) continue;
    whole_sky_.add(v_mag + 0.5 * StarSummary::step_mag,
                   brightest_colour * light_of_magnitude(v_mag), double(stars.count[bin]));
  }
  if (map.variables)  // at their brightest, beside themselves in the counts
    for (const VariableStars::Star& star : map.variables->stars())
      if (const double v_mag = brightest_v_mag(map, star.place); v_mag <= faintest_v_mag_)
        whole_sky_.add(v_mag, brightest_colour * light_of_magnitude(v_mag));
  whole_sky_.sum_up();
  fastest_rad_per_yr_ = map.index.fastest_motion_rad_per_yr;
  largest_parallax_rad_ = stars.largest_parallax_rad;
}

void StarFacts::add_trails(const View& view, PlanFacts& f) const {
  const Optics& optics = view.sensor().camera.optics;
  const auto start = view.camera_from_gcrs(view.times().start);
  const auto end = view.camera_from_gcrs(view.times().end);
  double shortest_px = unbounded;
  look_over(optics, 0.0, [&](PixelPosition at, const Vec<CameraFrame>& direction) {
    const auto there = project(optics, end * (start.inverse() * direction));
    if (!there) return;
    const double trail_px = std::hypot(there->x_px - at.x_px, there->y_px - at.y_px);
    shortest_px = std::min(shortest_px, trail_px);
    f.longest_trail_px = std::max(f.longest_trail_px, trail_px);
  });
  f.star_trail_px = std::isfinite(shortest_px) ? shortest_px : 0.0;
  f.longest_trail_px =
      std::min(f.longest_trail_px, std::hypot(double(optics.columns), double(optics.rows)));
}

/// Counts the stars of a catalogue whose trails touch a frame.
StarFacts::ByLimit StarFacts::counted(const View& view, const PlanFacts& f,
                                      double radius_rad) const {
  const Optics& optics = view.sensor().camera.optics;
  const FrameTimes& times = view.times();
  const std::array<Rotation<CameraFrame, Gcrs>, 3> camera{view.camera_from_gcrs(times.start),
                                                          view.camera_from_gcrs(times.middle),
                                                          view.camera_from_gcrs(times.end)};
  // Stars are where the frame has them: an effect that is off may move one into a narrow field.
  const EffectSet& effects = view.sensor().effects;
  Vec<Gcrs> velocity{0, 0, 0};
  if (effects.has(AnnualAberration::facts)) velocity += view.environment().earth_velocity_m_per_s;
  if (effects.has(DiurnalAberration::facts))
    velocity += view.observer(times.middle).velocity_m_per_s;
  const Vec<Gcrs> aberration = (1.0 / speed_of_light_m_per_s) * velocity;
  constexpr double places_rad = 2.0 / 3600.0 * deg;
  const double margin_px =
      3.0 * std::hypot(1.0, f.fwhm_px) +
      (places_rad + f.refraction_rad + f.star_shift_rad + f.star_parallax_rad) / f.pixel_rad;
  const StarTable& table = stars_->stars;
  std::vector<std::uint32_t> found;
  query_brightest(*stars_, view.boresight(times.middle), radius_rad, faintest_v_mag_, found);
  ByLimit stars;
  for (const std::uint32_t star : found) {
    const Vec<Gcrs> direction = unit(stars_->index.direction[star] + aberration);
    double left = unbounded, right = -unbounded, top = unbounded, bottom = -unbounded;
    for (const auto& at : camera)
      if (const auto pixel = project(optics, at * direction)) {
        left = std::min(left, pixel->x_px);
        right = std::max(right, pixel->x_px);
        top = std::min(top, pixel->y_px);
        bottom = std::max(bottom, pixel->y_px);
      }
    if (right > -margin_px && left < optics.columns + margin_px && bottom > -margin_px &&
        top < optics.rows + margin_px) {
      const double v_mag = brightest_v_mag(*stars_, star);
      stars.add(v_mag, light_.photons_per_s_m2(v_mag, table.colour(star)));
    }
  }
  stars.sum_up();
  stars.processed = double(found.size());
  return stars;
}

void StarFacts::add_stars(const View& view, PlanFacts& f) const {
  const SimTime middle = view.times().middle;
  const Vec<Gcrs> axis = view.boresight(middle);
  const double turned_rad = std::max(angle_rad(axis, view.boresight(view.times().start)),
                                     angle_rad(axis, view.boresight(view.times().end)));
  const double seen_rad =
      half_diagonal_rad(view.sensor().camera.optics) + turned_rad + displaced_rad;
  const bool is_counted = seen_rad + f.refraction_rad < widest_counted_rad;
  const ByLimit stars = is_counted ? counted(view, f, seen_rad + f.refraction_rad) : whole_sky_;
  const double electrons =
      Throughput(view).electrons_per_photon_m2() * view.times().seconds() *
      (view.on_ground() ? light_of_magnitude(0.9 * f.zenith_extinction_mag) : 1.0) *
      most_by_scintillation(f);
  // Places are computed of all stars around the field.
  const double around = share_of_sky(seen_rad + searched_rad);
  double processed = around;
  if (is_counted && stars.count.back() > 0.0)
    processed = stars.processed / stars.count.back() * around / share_of_sky(seen_rad);
  for (std::size_t m = 0; m < star_limits; ++m) {
    f.stars_brighter[m] = processed * stars.count[m];
    f.brightest_left_e[m] = electrons * stars.beyond[m];
  }
  f.stars = f.stars_brighter.back();
  f.brightest_star_e = electrons * stars.brightest;
  if (field_ && field_->synthetic())
    add_synthetic(*field_->synthetic(), axis, seen_rad, electrons, f);
}

/// A star may be as bright in the band as any of its magnitude.
void StarFacts::add_synthetic(const SyntheticStars& synthetic, const Vec<Gcrs>& axis,
                              double seen_rad, double electrons, PlanFacts& f) const {
  double brightest_colour = 0.0;  // light of a star in the synthetic colour with the most
  for (const double bv : {min_bv, double(default_star_bv), greatest_bv})
    brightest_colour = std::max(brightest_colour, light_.photons_per_s_m2(0.0, bv));
  for (std::size_t m = 0; m < star_limits; ++m) {
    const double limit = std::max(double(m), synthetic.from_v_mag());
    if (limit >= synthetic.to_v_mag()) break;
    const double left_e = electrons * brightest_colour * light_of_magnitude(limit);
    if (!to_frame_limit() || SyntheticBackground::is_seen(left_e, f))
      f.synthetic_left_e[m] = left_e;
  }
  // In wide fields as all of the sky has them, else as this part of it has.
  const bool is_wide = seen_rad >= widest_counted_rad;
  const double share = share_of_sky(seen_rad);
  double made = 0.0;
  for (std::size_t m = 0; m < star_limits; ++m) {
    const double limit = std::min(double(m), synthetic.to_v_mag());
    if (limit > synthetic.from_v_mag() && double(m) < synthetic.to_v_mag() + 1.0)
      made = is_wide ? share * (stars_of_all_sky(limit) - stars_of_all_sky(synthetic.from_v_mag()))
                     : synthetic.expected_around(axis, seen_rad, limit);
    f.synthetic_brighter[m] = made;
  }
}

void StarFacts::add(const View& view, PlanFacts& f) const {
  const auto& environment = view.environment();
  const SimTime middle = view.times().middle;
  const Vec<Gcrs> axis = view.boresight(middle);
  const double half_rad = half_diagonal_rad(view.sensor().camera.optics);
  f.nearest_sun_rad = std::max(
      0.0, angle_rad(axis, environment.sun_m - view.observer(middle).position_m) - half_rad);
  f.annual_aberration_rad =
      aberration_constant_rad * largest_sine(environment.earth_velocity_m_per_s, axis, half_rad);
  const Vec<Gcrs> velocity = view.observer(middle).velocity_m_per_s;
  f.diurnal_aberration_rad =
      1.01 * norm(velocity) / speed_of_light_m_per_s * largest_sine(velocity, axis, half_rad);
  add_trails(view, f);
  if (!stars_ || drawn_.to_v_mag == -unbounded) return;  // there are none in the frame
  const double years = 2000.0 +
                       julian_years_since_j2000(Tt{environment.tt_jd1, environment.tt_jd2}) -
                       stars_->stars.epoch_jyear;
  f.star_shift_rad = fastest_rad_per_yr_ * std::abs(years);
  f.star_parallax_rad = 1.02 * largest_parallax_rad_;
  add_stars(view, f);
}

}  // namespace dmise
