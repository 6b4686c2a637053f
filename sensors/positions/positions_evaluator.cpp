#include "sensors/positions/positions_evaluator.h"

#include <set>

#include "core/frames/geodesy.h"
#include "core/time/iso8601.h"
#include "core/visibility/sight.h"
#include "core/visibility/target_direction.h"
#include "sensors/scene/state_window.h"

namespace dmise {
namespace {

/// The equivalent quaternion with w >= 0.
Quaternion upright(const Quaternion& q) { return q.w < 0 ? Quaternion{-q.w, -q.x, -q.y, -q.z} : q; }

}  // namespace

PositionsEvaluator::PositionsEvaluator(const Scenario& scenario, Clock clock,
                                       const std::string& directory)
    : scenario_(scenario),
      clock_(std::move(clock)),
      files_(directory, scenario.output, format_utc(clock_.utc({0}), 9)) {}

std::string PositionsEvaluator::utc(Tick tick) const {
  return format_utc(clock_.utc(scenario_.time_of(tick)), 9);
}

Tick PositionsEvaluator::look_back() const {
  const SimTime environment_every = sim_seconds(scenario_.environment.common_every_s);
  return (environment_every.ns + scenario_.tick.ns - 1) / scenario_.tick.ns + 1;
}

void PositionsEvaluator::take_roster(const ObjectRoster& roster) {
  if (!mounts_.empty()) return;
  const std::size_t count = roster.objects.size();
  std::set<std::size_t> all;
  for (const auto& own : scenario_.own_objects)
    for (std::size_t i = 0; i < count; ++i)
      if (roster.objects[i].catalogue_number == own.catalogue_number) all.insert(i);
  for (const auto& sensor : scenario_.sensors) {
    Mount mount;
    if (const auto* platform = std::get_if<PlatformConfig>(&sensor.place))
      mount.platform = object_index(roster, platform->object, sensor.name + ": platform");
    if (const auto* target = std::get_if<PointTarget>(&sensor.pointing))
      mount.target = object_index(roster, target->object, sensor.name + ": pointing.target");
    for (const auto& needed : {mount.platform, mount.target})
      if (needed) all.insert(*needed);
    mounts_.push_back(mount);
  }
  objects_.assign(all.begin(), all.end());
  std::vector<ObjectInfo> infos;
  for (const std::size_t i : objects_) infos.push_back(roster.objects[i]);
  files_.open_ephemerides(infos);
}

void PositionsEvaluator::take_in(const Message& message) {
  if (const auto* roster = std::get_if<ObjectRoster>(message.state.get())) {
    roster_ = {message.state, roster};
    take_roster(*roster);
  }
  if (const auto* states = std::get_if<ObjectStates>(message.state.get()))
    states_ = {message.state, states};
  if (const auto* state = std::get_if<EnvironmentState>(message.state.get()))
    environment_ = {message.state, state};
}

std::optional<PositionRow> PositionsEvaluator::camera(std::size_t index, Tick tick) const {
  const SensorConfig& sensor = scenario_.sensors[index];
  const Mount& mount = mounts_[index];
  for (const auto& needed : {mount.platform, mount.target})
    if (needed && states_->code[*needed] != 0) return std::nullopt;
  const SimTime t = scenario_.time_of(tick);
  const EarthOrientation& earth = environment_->earth;
  PointingScene scene{.time = t, .itrs_from_gcrs = earth.itrs_from_gcrs(t)};
  const auto site = site_of(sensor);
  if (site) {
    scene.site = &*site;
    scene.observer = standing_at(itrs_from_geodetic(*site), earth, t);
  } else {
    scene.observer = {states_->position(*mount.platform), states_->slope(*mount.platform)};
  }
  if (mount.target &&
      norm(states_->position(*mount.target) - scene.observer.position_m) < Sight::nearest_m)
    return std::nullopt;
  if (mount.target)
    scene.towards_target =
        target_direction(sensor, scene, configured_refraction(sensor),
                         states_->position(*mount.target), states_->slope(*mount.target));
  if (mount.platform)
    if (const auto attitude = states_->attitude(*mount.platform))
      scene.gcrs_from_body = rotation_of<Gcrs, Body>(attitude->gcrs_from_body);
  PositionRow row{.tick = tick,
                  .time_utc = utc(tick),
                  .kind = sensor.is_camera() ? "camera" : "sensor",
                  .name = sensor.name,
                  .position_m = scene.observer.position_m,
                  .slope_m_per_s = scene.observer.velocity_m_per_s};
  if (sensor.is_camera()) row.gcrs_from_axes = upright(quaternion_of(aim(sensor, scene).inverse()));
  return row;
}

std::vector<PositionRow> PositionsEvaluator::rows(Tick tick) const {
  std::vector<PositionRow> rows;
  const std::string time_utc = utc(tick);
  if (environment_->tick == tick) {
    rows.push_back({.tick = tick,
                    .time_utc = time_utc,
                    .kind = "sun",
                    .name = "Sun",
                    .position_m = environment_->sun_m});
    rows.push_back({.tick = tick,
                    .time_utc = time_utc,
                    .kind = "moon",
                    .name = "Moon",
                    .position_m = environment_->moon_m});
  }
  for (const std::size_t i : objects_) {
    if (states_->code[i] != 0) continue;
    PositionRow row{.tick = tick,
                    .time_utc = time_utc,
                    .kind = "object",
                    .name = roster_->objects[i].name,
                    .catalogue_number = roster_->objects[i].catalogue_number,
                    .position_m = states_->position(i),
                    .slope_m_per_s = states_->slope(i)};
    if (const auto attitude = states_->attitude(i)) row.gcrs_from_axes = attitude->gcrs_from_body;
    rows.push_back(std::move(row));
  }
  for (std::size_t k = 0; k < mounts_.size(); ++k)
    if (auto row = camera(k, tick)) rows.push_back(std::move(*row));
  if (scenario_.output.positions_enu) turn_to_enu(rows, scenario_.time_of(tick));
  return rows;
}

void PositionsEvaluator::turn_to_enu(std::vector<PositionRow>& rows, SimTime t) const {
  const Site& origin = *scenario_.earth.origin;
  const Vec<Itrs> origin_m = itrs_from_geodetic(origin);
  const auto enu_from_itrs = dmise::enu_from_itrs(origin);
  const auto itrs_from_gcrs = environment_->earth.itrs_from_gcrs(t);
  for (PositionRow& row : rows) {
    const Vec<Itrs> place_m = itrs_from_gcrs * row.position_m;
    EnuPlace enu{.position_m = enu_from_itrs * (place_m - origin_m)};
    if (row.slope_m_per_s)
      enu.velocity_m_per_s =
          enu_from_itrs *
          (itrs_from_gcrs *
           (*row.slope_m_per_s - environment_->earth.velocity_of_fixed_point(place_m, t)));
    if (row.gcrs_from_axes)
      enu.enu_from_axes = upright(quaternion_of(enu_from_itrs * itrs_from_gcrs *
                                                rotation_of<Gcrs, Body>(*row.gcrs_from_axes)));
    row.enu = enu;
  }
}

void PositionsEvaluator::write(Tick tick) { files_.add(rows(tick), tick > 0 ? utc(tick - 1) : ""); }

std::vector<Message> PositionsEvaluator::resume(Tick tick, std::span<const Message> past) {
  for (const auto& message : past)
    if (std::holds_alternative<ObjectRoster>(*message.state)) take_in(message);
  bool again = false;
  for (const auto& message : past) {
    if (std::holds_alternative<ObjectRoster>(*message.state)) continue;
    if (message.tick < tick) take_in(message);
    again = again || (states_ && states_->tick == tick - 1 && environment_);
  }
  const Tick first = again ? tick - 1 : tick;
  files_.keep_before(first, utc(first));
  begun_ = true;
  if (again) write(first);
  return {};
}

std::vector<Message> PositionsEvaluator::step(Tick tick, std::span<const Message> inputs) {
  for (const auto& message : inputs) take_in(message);
  if (!begun_) files_.keep_before(0, utc(0));
  begun_ = true;
  write(tick);
  ++steps_;
  return {};
}

}  // namespace dmise
