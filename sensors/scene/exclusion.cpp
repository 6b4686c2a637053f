#include "sensors/scene/exclusion.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "core/base/numeric/golden_section.h"
#include "core/base/units.h"
#include "core/sky/bodies/earth_limb.h"
#include "sensors/scene/bodies_in_field.h"
#include "sensors/scene/view.h"

namespace dmise {
namespace {

constexpr double step_rad = 2.0 * deg;  // that the axis turns between two times
constexpr int fewest_steps = 4, max_steps = 4096;
constexpr double found_within = 1e-5;  // part of the two steps in which the least angle is sought

/// Whether no part of a disc is seen past the Earth.
bool is_hidden(const View& view, const SeenBody& body, SimTime t) {
  if (view.on_ground()) return dot(view.up(t), body.apparent) < -std::sin(body.radius_rad);
  return from_limb_rad(view.observer(t).position_m, body.apparent, view.surface()) <
         -body.radius_rad;
}

using AngleAt = std::function<double(SimTime)>;

/// The least angle between the neighbours of a time at which it is less than at these.
double least_between(const AngleAt& angle, SimTime from, SimTime to, double least) {
  const auto at = [&](double share) {
    return angle({from.ns + std::llround(share * double(to.ns - from.ns))});
  };
  return std::min(least, golden_section(at, 0.0, 1.0, found_within).value);
}

/// Times at which the angles of an exposure are computed.
struct Looks {
  std::vector<SimTime> times;
  SimTime reach;      // on either side of one, in which the axis turns little
  bool many_turns{};  // too many for times between which it turns little: all phases of a turn
};

Looks looks_of(const View& view) {
  const FrameTimes all = view.times_of_all_rows();
  const SimTime moment{std::clamp<std::int64_t>((all.end - all.start).ns / 1000, 1, 1'000'000)};
  double fastest_rad = 0.0;
  for (const SimTime t : {all.start, all.at(0.5), all.end - moment})
    fastest_rad = std::max(fastest_rad, angle_rad(view.boresight(t), view.boresight(t + moment)));
  const double steps = fastest_rad / moment.seconds() * all.seconds() / step_rad;
  Looks looks{.times = {}, .reach = {}, .many_turns = steps > max_steps};
  const int count =
      std::clamp(int(std::min(steps, double(max_steps))) + 1, fewest_steps, max_steps);
  looks.reach = {(all.end - all.start).ns /
                 std::int64_t(std::max(1.0, std::max(steps, double(count))))};
  const double golden = 0.6180339887498949;
  for (int k = 0; k <= count; ++k) {
    const double within = looks.many_turns ? std::fmod(k * golden, 1.0) - 0.5 : 0.0;
    looks.times.push_back(all.at(std::clamp((k + within) / count, 0.0, 1.0)));
  }
  return looks;
}

double least_of(const Looks& looks, const AngleAt& angle) {
  const auto& times = looks.times;
  std::vector<double> angles;
  for (const SimTime t : times) angles.push_back(angle(t));
  double least = *std::ranges::min_element(angles);
  for (std::size_t k = 0; k < times.size(); ++k) {
    const double here = angles[k];
    const std::size_t before = k == 0 ? 0 : k - 1, after = std::min(k + 1, times.size() - 1);
    const bool is_least = looks.many_turns ? here < least + step_rad / 4
                                           : here <= angles[before] && here <= angles[after];
    if (!is_least) continue;
    least = std::min(least, least_between(angle, std::max(times.front(), times[k] - looks.reach),
                                          std::min(times.back(), times[k] + looks.reach), here));
  }
  return least;
}

std::optional<double> least_from(const View& view, const Looks& looks,
                                 SeenBody (*seen)(const View&, SimTime)) {
  if (std::ranges::all_of(looks.times,
                          [&](SimTime t) { return is_hidden(view, seen(view, t), t); }))
    return std::nullopt;
  return least_of(looks,
                  [&](SimTime t) { return angle_rad(view.boresight(t), seen(view, t).apparent); });
}

}  // namespace

BodyAngles body_angles(const View& view) {
  const Exclusion& limits = view.sensor().camera.exclusion;
  BodyAngles angles;
  if (!limits.any()) return angles;
  const Looks looks = looks_of(view);
  if (limits.sun_deg) angles.sun_rad = least_from(view, looks, truly_seen_sun);
  if (limits.moon_deg) angles.moon_rad = least_from(view, looks, truly_seen_moon);
  if (limits.earth_limb_deg && !view.on_ground())
    angles.earth_limb_rad = least_of(looks, [&](SimTime t) {
      return from_limb_rad(view.observer(t).position_m, view.boresight(t), view.surface());
    });
  return angles;
}

Excluded excluded_by(const Exclusion& exclusion, const BodyAngles& angles) {
  Excluded excluded;
  for (const ExcludingBody& body : excluding_bodies) {
    const auto& angle_rad = angles.*body.angle_rad;
    const auto& limit_deg = exclusion.*body.limit_deg;
    excluded.*body.excluded = angle_rad && limit_deg && *angle_rad < *limit_deg * deg;
  }
  return excluded;
}

}  // namespace dmise
