#include "sensors/planning/error_facts.h"

#include <algorithm>
#include <cmath>

#include "core/effects/plan_facts.h"
#include "core/frames/earth_orientation.h"
#include "core/frames/rotation_angle.h"

namespace dmise {
namespace {

constexpr double margin = 1.25;  // a camera may turn unevenly

/// Returns by how much the camera turns a second, against the ground or, in orbit, the stars.
double camera_rate_rad_per_s(const View& view) {
  const FrameTimes& times = view.times();
  const auto camera = [&](SimTime t) {
    const auto from_gcrs = view.camera_from_gcrs(t);
    const Rotation<Gcrs, Itrs> gcrs_from_ground =
        view.on_ground() ? view.earth().itrs_from_gcrs(t).inverse() : Rotation<Gcrs, Itrs>{};
    return from_gcrs * gcrs_from_ground;
  };
  return margin * rotation_angle_rad(camera(times.end) * camera(times.start).inverse()) /
         times.seconds();
}

}  // namespace

void add_error_facts(const View& view, PlanFacts& f) {
  const ExposureErrors& errors = view.errors();
  const FrameTimes &told = errors.commanded(), &truly = view.times();
  if (errors.displace())
    for (const SimTime t : {truly.start, truly.end})
      f.pointing_error_rad =
          std::max(f.pointing_error_rad, rotation_angle_rad(errors.true_from_commanded(t)));
  if (!errors.of_clock()) return;
  f.clock_error_s = std::max(std::abs((truly.start - told.start).seconds()),
                             std::abs((truly.end - told.end).seconds()));
  f.star_rate_rad_per_s =
      camera_rate_rad_per_s(view) + (view.on_ground() ? earth_turn_rad_per_s : 0.0);
}

}  // namespace dmise
