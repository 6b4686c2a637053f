#include "sensors/objects/objects_in_field.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "core/base/units.h"
#include "core/frames/rotation_angle.h"
#include "core/optics/projection.h"
#include "core/visibility/crossing.h"
#include "core/visibility/field_of_view.h"
#include "core/visibility/sight.h"

namespace dmise {
namespace {

/// Light time, aberration and refraction move an object by less than this.
constexpr double widest_shift_rad = 1.0 * deg;

/// Accelerations of object and observer together: twice that at the Earth's surface.
constexpr double greatest_pull_m_per_s2 = 20.0;

/// A path that touches the field for no longer than this part of the exposure, or than this, may be
/// missed.
constexpr double shortest_share = 1e-3;
constexpr double shortest_crossing_s = 0.02;

/// Greatest acceleration of what orbits the Earth above its surface.
constexpr double greatest_fall_m_per_s2 = 10.0;

/// SGP4's velocity differs from the derivative of its position by less.
constexpr double greatest_slope_error_m_per_s = 20.0;

/// Rounding, and frames that turn a little between two times.
constexpr double rough_margin_m = 1000.0;

/// With a wider cone, or a camera that turns more during half the exposure, all objects are
/// candidates.
constexpr double widest_rough_cone_rad = 170.0 * deg, max_turning_rad = 0.1;

/// The camera's turning is taken from attitudes no farther apart than this.
constexpr double longest_look_s = 10.0;

/// Directions that may touch the frame, around a camera that moves and turns during an exposure.
class FieldCone {
 public:
  explicit FieldCone(const View& view) : view_(view), exposure_(view.times_of_all_rows()) {
    const double half =
        std::min(pi, half_diagonal_rad(view.sensor().camera.optics) + widest_shift_rad);
    cos_ = std::cos(half);
    sin_ = std::sin(half);
    for (const SimTime t : {exposure_.start, exposure_.middle, exposure_.end})
      moments_.emplace(t.ns, at(t));
    half_s_ = 0.5 * exposure_.seconds();
    // A quarter more than attitudes show: those at start, middle and end, and more in a long
    // exposure, in which the camera may turn there and back.
    const auto turned = [&](SimTime a, SimTime b) {
      return rotation_angle_rad(moment(a).camera * moment(b).camera.inverse());
    };
    const int halves = std::max(1, int(std::ceil(half_s_ / longest_look_s)));
    for (int k = 0; k < 2 * halves; ++k) {
      const SimTime a = looked_at(k, halves), b = looked_at(k + 1, halves);
      turn_rad_per_s_ = std::max(turn_rad_per_s_, 1.25 * halves / half_s_ * turned(a, b));
    }
  }

  /// Whether an object is where the sensor is: its own host, under whatever number.
  bool at_sensor(std::size_t object) {
    for (const SimTime t : {exposure_.start, exposure_.middle, exposure_.end})
      if (norm(view_.states().motion(object, t).position_m - moment(t).observer.position_m) <
          Sight::nearest_m)
        return true;
    return false;
  }

  /// Objects of `rough` that `crossed_by` may accept.
  std::vector<std::uint32_t> candidates(RoughPlaces& rough);

  /// `radius_m`: of the sphere about the object that holds it.
  bool crossed_by(std::size_t object, double radius_m) {
    radius_m_ = radius_m;
    const Motion motion = view_.states().motion(object, exposure_.middle);
    const ObserverState& observer = moment(exposure_.middle).observer;
    const double range_m = norm(motion.position_m - observer.position_m);
    const double speed =
        norm(motion.slope_m_per_s - observer.velocity_m_per_s) + greatest_pull_m_per_s2 * half_s_;
    const double speed_in_axes = speed + turn_rad_per_s_ * (range_m + speed * half_s_);
    const double middle_m = outside_m(object, exposure_.middle);
    if (middle_m <= 0.0) return true;
    if (middle_m > speed_in_axes * half_s_) return false;
    const double start_m = outside_m(object, exposure_.start);
    const double end_m = outside_m(object, exposure_.end);
    if (start_m <= 0.0 || end_m <= 0.0) return true;
    const auto may_cross = [&](double a_m, double b_m, double s) {
      return a_m + b_m <= speed_in_axes * s;
    };
    const auto distance_m = [&](SimTime t) { return outside_m(object, t); };
    const double shortest_s = std::min(shortest_crossing_s, shortest_share * exposure_.seconds());
    return crossing_between(exposure_.start, start_m, exposure_.middle, middle_m, shortest_s,
                            may_cross, distance_m) ||
           crossing_between(exposure_.middle, middle_m, exposure_.end, end_m, shortest_s, may_cross,
                            distance_m);
  }

 private:
  struct Moment {
    Rotation<CameraFrame, Gcrs> camera;
    ObserverState observer;
  };
  /// Instant `k` of 2 `halves`, evenly before and after the middle.
  SimTime looked_at(int k, int halves) const {
    const auto& [frame, start, middle, end] = exposure_;
    if (k <= halves) return {start.ns + (middle.ns - start.ns) * k / halves};
    return {middle.ns + (end.ns - middle.ns) * (k - halves) / halves};
  }
  Moment at(SimTime t) const { return {view_.camera_from_gcrs(t), view_.observer(t)}; }
  /// Worked out once for each instant that is asked for.
  const Moment& moment(SimTime t) {
    const auto found = moments_.find(t.ns);
    return found != moments_.end() ? found->second : moments_.emplace(t.ns, at(t)).first->second;
  }
  double outside_m(std::size_t object, SimTime t) {
    const Moment& now = moment(t);
    const Vec<CameraFrame> line =
        now.camera * (view_.states().motion(object, t).position_m - now.observer.position_m);
    return outside_cone_m(line, Vec<CameraFrame>{0, 0, 1}, cos_, sin_) - radius_m_;
  }

  /// Observer and camera axis at mid exposure, in the frame of the rough places.
  struct Stance {
    Vec<Teme> observer_m, carried_m_per_s, axis;
  };
  double error_m(const RoughPlaces& rough, double dt_s) const;
  double pull_m_per_s(double dt_s) const;
  bool holds(const Shortlist& list, const Stance& sight) const;
  Shortlist shortlist_of(const RoughPlaces& rough, const Stance& sight) const;

  const View& view_;
  const FrameTimes exposure_;
  double cos_ = 1.0, sin_ = 0.0, half_s_ = 0.0, turn_rad_per_s_ = 0.0, radius_m_ = 0.0;
  std::map<std::int64_t, Moment> moments_;
};

/// Greatest distance between a straight line from a rough place and the object, `dt_s` later.
double FieldCone::error_m(const RoughPlaces& rough, double dt_s) const {
  return 0.5 * greatest_fall_m_per_s2 * dt_s * dt_s +
         greatest_slope_error_m_per_s * std::abs(dt_s) + rough.interpolation_error_m +
         rough_margin_m;
}

/// What speeds relative to the observer may grow by until the end of the exposure.
double FieldCone::pull_m_per_s(double dt_s) const {
  return greatest_pull_m_per_s2 * half_s_ + greatest_slope_error_m_per_s +
         greatest_fall_m_per_s2 * std::abs(dt_s);
}

bool FieldCone::holds(const Shortlist& list, const Stance& sight) const {
  return norm(sight.observer_m - list.observer_m) <= list.moved_m &&
         norm(sight.axis - list.axis) <= list.turned_rad && cos_ >= list.cos_half &&
         half_s_ <= list.half_exposure_s && turn_rad_per_s_ <= list.turn_rad_per_s &&
         norm(sight.carried_m_per_s) <= list.observer_speed_m_per_s;
}

/// Limits are what the camera will do until the rough places are made anew, a little more than it
/// does now.
Shortlist FieldCone::shortlist_of(const RoughPlaces& rough, const Stance& sight) const {
  const double span_s = rough.longest_s;
  Shortlist list{.observer_m = sight.observer_m,
                 .axis = sight.axis,
                 .cos_half = cos_,
                 .half_exposure_s = 1.01 * half_s_,
                 .turn_rad_per_s = 1.5 * turn_rad_per_s_ + 1e-6,
                 .observer_speed_m_per_s = 1.01 * norm(sight.carried_m_per_s) + 1.0};
  list.moved_m = 2.0 * span_s * list.observer_speed_m_per_s + 1000.0;
  list.turned_rad = std::min(0.4, 2.0 * span_s * list.turn_rad_per_s);
  const double error_m = this->error_m(rough, span_s), pull_m_per_s = this->pull_m_per_s(span_s);
  const std::size_t stride = rough.code.size();
  const auto vec = [&](const std::vector<double>& xyz, std::size_t i) {
    return Vec<Teme>{xyz[i], xyz[stride + i], xyz[2 * stride + i]};
  };
  for (std::size_t i = 0; i < rough.count; ++i) {
    if (rough.code[i] != 0) {
      list.without_place.push_back(std::uint32_t(i));
      continue;
    }
    const Vec<Teme> place = vec(rough.position_m, i), velocity = vec(rough.velocity_m_per_s, i);
    const Vec<Teme> line = place - sight.observer_m;
    const double own_speed = norm(velocity);
    const double moved_m = own_speed * span_s + list.moved_m, range_m = norm(line) + moved_m;
    const double speed = own_speed + list.observer_speed_m_per_s + pull_m_per_s;
    const double reach_m =
        error_m +
        list.half_exposure_s *
            (speed + list.turn_rad_per_s * (range_m + error_m + speed * list.half_exposure_s));
    if (outside_cone_m(line, sight.axis, cos_, sin_) <=
        moved_m + 1.01 * list.turned_rad * range_m + reach_m)
      list.places.push_back({place, velocity, std::uint32_t(i)});
  }
  return list;
}

std::vector<std::uint32_t> FieldCone::candidates(RoughPlaces& rough) {
  std::vector<std::uint32_t> found;
  const double turning_rad = turn_rad_per_s_ * half_s_;
  const double half_rad = std::atan2(sin_, cos_) + std::asin(std::min(1.0, turning_rad));
  if (half_rad > widest_rough_cone_rad || turning_rad > max_turning_rad) {
    found.resize(rough.count);
    std::iota(found.begin(), found.end(), 0u);
    return found;
  }
  const SimTime middle = exposure_.middle;
  const Moment& now = moment(middle);
  const double dt_s = (middle - rough.time).seconds();
  const double error_m = this->error_m(rough, dt_s), pull_m_per_s = this->pull_m_per_s(dt_s);
  const auto teme_from_gcrs = rough.gcrs_from_teme.inverse();
  const Stance sight{teme_from_gcrs * now.observer.position_m,
                     teme_from_gcrs * now.observer.velocity_m_per_s,
                     unit(teme_from_gcrs * (now.camera.inverse() * Vec<CameraFrame>{0, 0, 1}))};
  if (!rough.shortlist || !holds(*rough.shortlist, sight))
    rough.shortlist = shortlist_of(rough, sight);
  found = rough.shortlist->without_place;
  for (const auto& [place, velocity, object] : rough.shortlist->places) {
    const Vec<Teme> line = place + velocity * dt_s - sight.observer_m;
    const double speed = norm(velocity - sight.carried_m_per_s) + pull_m_per_s;
    const double reach_m =
        (speed + turn_rad_per_s_ * (norm(line) + error_m + speed * half_s_)) * half_s_ + error_m;
    if (outside_cone_m(line, sight.axis, cos_, sin_) <= reach_m) found.push_back(object);
  }
  return found;
}

}  // namespace

std::vector<std::uint32_t> may_be_in_field(const View& view, RoughPlaces& rough) {
  return FieldCone(view).candidates(rough);
}

std::set<std::size_t> needed_objects(const SensorConfig& sensor, const ObjectRoster& roster) {
  std::set<std::size_t> needed;
  if (const auto* platform = std::get_if<PlatformConfig>(&sensor.place))
    needed.insert(object_index(roster, platform->object, platform->where));
  if (const auto* target = std::get_if<PointTarget>(&sensor.pointing))
    needed.insert(object_index(roster, target->object, target->where));
  return needed;
}

std::vector<std::size_t> objects_in_field(const View& view, const ObjectShapes* shapes) {
  const FrameTimes exposure = view.times_of_all_rows();
  const auto& window = view.states();
  FieldCone cone(view);
  std::vector<std::size_t> found;
  const auto& known = window.restricted_to();
  const std::size_t count = known ? known->size() : window.object_count();
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t i = known ? (*known)[k] : k;
    if (view.platform() == i || !window.has_state(i, exposure.start) ||
        !window.has_state(i, exposure.end) || !window.has_state(i, exposure.middle))
      continue;
    const ObjectShape* shape = shapes ? shapes->of(window.roster().objects[i]) : nullptr;
    if (cone.crossed_by(i, shape ? shape->radius_m : 0.0) && !cone.at_sensor(i)) found.push_back(i);
  }
  return found;
}

}  // namespace dmise
