#include "sensors/sky/field_stars.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/config/sensors/effect_list.h"
#include "core/effects/frame_effects.h"
#include "core/optics/projection.h"
#include "core/sky/stars/star_counts.h"
#include "sensors/sky/star_exposure.h"

namespace dmise {

double turned_rad(const View& view) {
  const Vec<Gcrs> middle = view.boresight(view.times().middle);
  const FrameTimes times = view.times_of_all_rows();
  return std::max(angle_rad(middle, view.boresight(times.start)),
                  angle_rad(middle, view.boresight(times.end)));
}

FieldStars::FieldStars(const SensorConfig& sensor, std::shared_ptr<const StarMap> map,
                       double faintest_v_mag)
    : map_(std::move(map)) {
  if (!scene_facts(sensor).synthetic_stars) return;
  auto synthetic = std::make_unique<const SyntheticStars>(
      map_, faintest_v_mag, std::min(*sensor.synthetic_stars_to_v_mag, StarCounts::last_v_mag));
  to_frame_limit_ = std::isinf(*sensor.synthetic_stars_to_v_mag);
  if (synthetic->from_v_mag() < synthetic->to_v_mag()) synthetic_ = std::move(synthetic);
}

std::vector<std::uint32_t> FieldStars::candidates(const View& view, double faintest_v_mag) const {
  std::vector<std::uint32_t> found;
  query_brightest(
      *map_, view.boresight(view.times().middle),
      half_diagonal_rad(view.sensor().camera.optics) + turned_rad(view) + widest_shift_rad,
      faintest_v_mag, found);
  return found;
}

DrawnStars FieldStars::drawn(double limit_v_mag, const EffectSet& effects) const {
  const double complete = std::min(limit_v_mag, map_->summary.faintest_filled_v_mag);
  if (!synthetic_) return {complete};
  // Stars that are left out at the bright end are in the smooth starlight with all fainter ones.
  if (limit_v_mag < synthetic_->from_v_mag()) return {limit_v_mag, true};
  return {std::max(synthetic_->from_v_mag(), synthetic_limit_v_mag(effects)), true};
}

double FieldStars::synthetic_limit_v_mag(const EffectSet& effects) const {
  const int level = effects.level(SyntheticBackground::facts);
  if (to_frame_limit_ && level == SyntheticBackground::facts.reference()) return -unbounded;
  return std::min(synthetic_->to_v_mag(), SyntheticBackground::limit_v_mag(level));
}

double FieldStars::expected_synthetic(const View& view, const EffectSet& effects) const {
  if (!synthetic_) return 0.0;
  const double limit = synthetic_limit_v_mag(effects);
  const Optics& optics = view.sensor().camera.optics;
  const SimTime middle = view.times().middle;
  const auto gcrs_from_camera = view.camera_from_gcrs(middle).inverse();
  const auto earth = view.earth_occultation(middle);
  const Vec<Gcrs> up = view.up(middle);
  // Pieces of the frame with the area that their edges span.
  constexpr int pieces = 24;
  const double width_px = double(optics.columns) / pieces, height_px = double(optics.rows) / pieces;
  double sum = 0.0;
  for (int i = 0; i < pieces; ++i)
    for (int j = 0; j < pieces; ++j) {
      const PixelPosition at{(i + 0.5) * width_px - 0.5, (j + 0.5) * height_px - 0.5};
      const auto here = unproject(optics, at);
      const auto right = unproject(optics, {at.x_px + 0.5, at.y_px});
      const auto below = unproject(optics, {at.x_px, at.y_px + 0.5});
      if (!here || !right || !below) continue;
      const Vec<Gcrs> direction = gcrs_from_camera * *here;
      if (view.on_ground() ? dot(up, direction) < 0.0 : earth && earth->hides_direction(direction))
        continue;
      const double area_sr =
          4.0 * norm(cross(*right - *here, *below - *here)) * width_px * height_px;
      sum += synthetic_->per_square_degree(direction, limit) * area_sr / (deg * deg);
    }
  return sum;
}

std::uint32_t FieldStars::count(const View& view, double faintest_v_mag, double margin_px) const {
  const StarExposure exposure{.view = view, .map = *map_};
  const auto& grid = view.sensor().camera.optics;
  std::uint32_t inside = 0;
  for (const StarTrail& trail : exposure.trails(candidates(view, faintest_v_mag))) {
    if (exposure.hides(trail.middle)) continue;
    const auto [start, middle, end] = trail.pixel;
    const auto [first_x, last_x] = std::minmax({start.x_px, middle.x_px, end.x_px});
    const auto [first_y, last_y] = std::minmax({start.y_px, middle.y_px, end.y_px});
    inside += last_x > -0.5 - margin_px && first_x < grid.columns - 0.5 + margin_px &&
              last_y > -0.5 - margin_px && first_y < grid.rows - 0.5 + margin_px;
  }
  return inside;
}

}  // namespace dmise
