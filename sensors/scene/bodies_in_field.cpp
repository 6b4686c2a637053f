#include "sensors/scene/bodies_in_field.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/units.h"
#include "core/optics/projection.h"
#include "core/sky/bodies/earth_disc.h"
#include "core/sky/bodies/limb_airglow.h"
#include "core/sky/bodies/limb_extinction.h"
#include "core/sky/bodies/moon_disc.h"
#include "core/sky/bodies/sun_disc.h"
#include "core/sky/limb_air.h"
#include "sensors/scene/limb_layer.h"
#include "sensors/scene/seen_planet.h"
#include "sensors/scene/view.h"

namespace dmise {
namespace {

constexpr int around = 48;
constexpr double small_rad = 5.0 * deg;
constexpr double beyond_limb = 1.02;  // so that chords between points enclose the disc

/// Directions about a disc's limb.
std::array<Vec<Gcrs>, around> limb(const Vec<Gcrs>& centre, double radius_rad) {
  const Vec<Gcrs> any = std::abs(centre.z) < 0.9 ? Vec<Gcrs>{0, 0, 1} : Vec<Gcrs>{1, 0, 0};
  const Vec<Gcrs> u = unit(cross(any, centre)), v = cross(centre, u);
  std::array<Vec<Gcrs>, around> points;
  for (int i = 0; i < around; ++i) {
    const double at = 2.0 * pi * i / around;
    points[std::size_t(i)] = centre * std::cos(radius_rad) +
                             (u * std::cos(at) + v * std::sin(at)) * std::sin(radius_rad);
  }
  return points;
}

SeenBody seen(const View& view, const ApparentPlaces& places, SimTime t, const Vec<Gcrs>& middle_m,
              const Vec<Gcrs>& velocity, double radius_m) {
  const Vec<Gcrs> now_m = middle_m + velocity * (t - view.environment().time).seconds();
  const SatellitePlace place = places.satellite(now_m, velocity);
  return {.above_air_m = place.aberrated * place.range_m,
          .apparent = place.direction,
          .radius_rad = std::asin(std::min(1.0, radius_m / place.range_m))};
}

SeenBody sun(const View& view, const ApparentPlaces& places, SimTime t) {
  const auto& e = view.environment();
  return seen(view, places, t, e.sun_m, -e.earth_velocity_m_per_s, sun_radius_m);
}

SeenBody moon(const View& view, const ApparentPlaces& places, SimTime t) {
  const auto& e = view.environment();
  return seen(view, places, t, e.moon_m, e.moon_velocity_m_per_s, moon_radius_m);
}

/// A quick bound: false for nearly all fields.
bool may_be_near(const View& view, const Vec<Gcrs>& direction, double radius_rad, SimTime t) {
  const Optics& optics = view.sensor().camera.optics;
  const double margin_rad = 3.0 * disc_margin_px * optics.pixel_angle_rad();
  return angle_rad(view.boresight(t), direction) <
         half_diagonal_rad(optics) + beyond_limb * radius_rad + margin_rad;
}

bool is_seen(const View& view, const SeenBody& body, SimTime t) {
  if (!may_be_near(view, body.apparent, body.radius_rad, t)) return false;
  if (box_of(view, body, t, disc_margin_px).empty()) return false;
  const auto earth = view.earth_occultation(t);
  if (!earth || !earth->hides_direction(body.apparent)) return true;
  return std::ranges::any_of(limb(body.apparent, body.radius_rad),
                             [&](const auto& at) { return !earth->hides_direction(at); });
}

bool earth_is_seen(const View& view, SimTime t) {
  const Vec<Gcrs> here_m = view.observer(t).position_m;
  const double radius_rad = std::asin(
      std::min(1.0, view.sensor().ellipsoid.equatorial_radius_m / std::max(norm(here_m), 1.0)));
  const SeenBody centre{.apparent = -unit(here_m), .radius_rad = radius_rad};
  if (!may_be_near(view, centre.apparent, radius_rad, t)) return false;
  if (radius_rad < small_rad) return !box_of(view, centre, t, disc_margin_px).empty();
  const Optics& optics = view.sensor().camera.optics;
  const FreeSight sight(here_m, view.surface());
  const auto gcrs_from_camera = view.camera_from_gcrs(t).inverse();
  constexpr int steps = 32;
  const auto along = [](int i, int length) {
    return -0.5 - disc_margin_px + (length + 2.0 * disc_margin_px) * i / steps;
  };
  for (int j = 0; j <= steps; ++j)
    for (int i = 0; i <= steps; ++i) {
      const auto at = unproject(optics, {along(i, optics.columns), along(j, optics.rows)});
      if (at && !sight.clear_direction(gcrs_from_camera * *at)) return true;
    }
  return false;
}

}  // namespace

SeenBody seen_sun(const View& view, SimTime t) { return sun(view, view.places(t), t); }
SeenBody seen_moon(const View& view, SimTime t) { return moon(view, view.places(t), t); }
SeenBody truly_seen_sun(const View& view, SimTime t) { return sun(view, view.true_places(t), t); }
SeenBody truly_seen_moon(const View& view, SimTime t) { return moon(view, view.true_places(t), t); }

DiscBox frame_and_margin(const View& view, int margin_px) {
  const Optics& optics = view.sensor().camera.optics;
  return {-margin_px, -margin_px, optics.columns + margin_px, optics.rows + margin_px};
}

DiscBox box_of(const View& view, const SeenBody& body, SimTime t, int margin_px) {
  const DiscBox whole = frame_and_margin(view, margin_px);
  const Optics& optics = view.sensor().camera.optics;
  const auto camera = view.camera_from_gcrs(t);
  double left = 1e9, top = 1e9, right = -1e9, bottom = -1e9;
  for (const auto& at : limb(body.apparent, std::min(beyond_limb * body.radius_rad, pi))) {
    const auto pixel = project(optics, camera * at);
    if (!pixel && body.radius_rad > small_rad) return whole;
    if (!pixel) continue;  // a small disc is all far beside the frame
    left = std::min(left, pixel->x_px);
    right = std::max(right, pixel->x_px);
    top = std::min(top, pixel->y_px);
    bottom = std::max(bottom, pixel->y_px);
  }
  const auto low = [](double px, int least, int most) {
    return int(std::clamp(std::floor(px) - 1, double(least), double(most)));
  };
  const auto high = [](double px, int least, int most) {
    return int(std::clamp(std::ceil(px) + 2, double(least), double(most)));
  };
  return {low(left, whole.left, whole.right), low(top, whole.top, whole.bottom),
          high(right, whole.left, whole.right), high(bottom, whole.top, whole.bottom)};
}

BodiesInField bodies_in_field(const View& view) {
  const EffectSet& effects = view.sensor().effects;
  const FrameTimes times = view.times_of_all_rows();
  BodiesInField bodies;
  const bool with_limb =
      !view.on_ground() && (effects.has(LimbAirglow::facts) || effects.has(LimbAir::facts) ||
                            effects.has(LimbExtinction::facts));
  std::vector<SimTime> looks{times.middle, times.start, times.end};
  if (view.rolls()) looks.insert(looks.end(), {times.at(0.25), times.at(0.75)});
  for (const SimTime t : looks) {
    if (effects.has(SunDisc::facts)) bodies.sun = bodies.sun || is_seen(view, seen_sun(view, t), t);
    if (effects.has(MoonDisc::facts))
      bodies.moon = bodies.moon || is_seen(view, seen_moon(view, t), t);
    if (effects.has(EarthDisc::facts) && !view.on_ground())
      bodies.earth = bodies.earth || earth_is_seen(view, t);
    if (with_limb) bodies.limb = bodies.limb || limb_is_seen(view, t);
  }
  if (effects.has(Planets::facts)) bodies.planets = planets_in_field(view, looks);
  return bodies;
}

}  // namespace dmise
