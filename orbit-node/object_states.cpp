#include "orbit-node/object_states.h"

#include <array>
#include <optional>

#include "core/base/error.h"
#include "core/frames/oblate_earth.h"
#include "core/orbit/interpolation.h"
#include "core/sky/sun_moon.h"
#include "core/time/iso8601.h"

namespace dmise {
namespace {

constexpr std::int64_t half_step_ns = std::int64_t(slope_half_step_s * 1e9);
constexpr double least_height_m = 1.0;  // above the ellipsoid, of freely moving objects

void set(std::vector<double>& xyz, std::size_t count, std::size_t i, const Vec<Gcrs>& v) {
  xyz[i] = v.x;
  xyz[count + i] = v.y;
  xyz[2 * count + i] = v.z;
}
template <class F>
Vec<F> get(const std::vector<double>& xyz, std::size_t count, std::size_t i) {
  return {xyz[i], xyz[count + i], xyz[2 * count + i]};
}

/// Position and velocity with the code of the motion model.
struct Placed {
  MotionState<Gcrs> state;
  std::uint8_t code = 0;
};

bool is_fixed(const MotionModel& model) {
  return std::holds_alternative<ConstantPosition<Itrs>>(model) ||
         std::holds_alternative<ConstantPosition<Gcrs>>(model);
}

}  // namespace

/// One instant with the inputs of the models.
struct StateSource::Instant {
  SimTime time;
  Tai tai;
  EarthOrientation earth;
  // States of SGP4 in TEME: 3 x elements.
  std::vector<double> position_m, velocity_m_per_s;
  std::vector<std::uint8_t> code;

  Instant(const Clock& clock, SimTime t)
      : time(t), tai(clock.tai(t)), earth(earth_orientation(clock, t)) {}

  /// State from another model; its velocity is the slope of the position.
  Placed placed(const MotionModel& model) const {
    if (const auto* path = std::get_if<Trajectory>(&model); path && !covers(*path, tai))
      return {{}, std::uint8_t(MotionCode::outside_span)};
    try {
      const auto state = in_gcrs(path_at(model, tai), earth, time);
      const OblateEarth body = oblate_earth(earth);
      if (is_fixed(model) || norm(body.stretched(state.position_m)) >
                                 body.ellipsoid.equatorial_radius_m + least_height_m)
        return {state, 0};
    } catch (const Error&) {  // a path through the Earth's centre
    }
    return {{}, std::uint8_t(MotionCode::underground)};
  }

  Placed of_sgp4(std::size_t i) const {
    const auto gcrs_from_teme = earth.gcrs_from_teme(time);
    const std::size_t n = code.size();
    return {{gcrs_from_teme * get<Teme>(position_m, n, i),
             gcrs_from_teme * get<Teme>(velocity_m_per_s, n, i)},
            code[i]};
  }
};

StateSource::StateSource(const ObjectPopulation& population, Clock clock, Threads& threads)
    : population_(population),
      clock_(std::move(clock)),
      threads_(threads),
      batch_(population.elements) {}

ObjectStates StateSource::at(Tick tick, SimTime time) const {
  const std::size_t n = population_.roster.objects.size();
  ObjectStates states{.tick = tick, .time = time, .count = n};
  for (auto* numbers : {&states.position_m, &states.slope_m_per_s, &states.velocity_m_per_s})
    numbers->assign(3 * n, 0.0);
  states.code.assign(n, 0);
  Instant instants[3] = {
      {clock_, {time.ns - half_step_ns}}, {clock_, time}, {clock_, {time.ns + half_step_ns}}};
  if (const std::size_t k = batch_.size(); k > 0) {
    for (Instant& instant : instants) {
      instant.position_m.resize(3 * k);
      instant.velocity_m_per_s.resize(3 * k);
      instant.code.resize(k);
      const Utc utc = clock_.utc(instant.time);
      batch_.propagate(utc.jd1, utc.jd2, instant.position_m, instant.velocity_m_per_s, instant.code,
                       &threads_);
    }
    add_sgp4(instants, states);
  }
  add_models(instants[1], states);
  if (!population_.attitudes.empty()) add_attitudes(instants, states);
  return states;
}

void StateSource::add_sgp4(const Instant (&instants)[3], ObjectStates& states) const {
  const std::size_t n = states.count, k = batch_.size();
  const auto& [before, now, after] = instants;
  std::array<Rotation<Gcrs, Teme>, 3> gcrs_from_teme;
  for (std::size_t j = 0; j < 3; ++j)
    gcrs_from_teme[j] = instants[j].earth.gcrs_from_teme(instants[j].time);
  const double span_s = 2e-9 * half_step_ns;
  for (std::size_t i = 0; i < k; ++i) {
    states.code[i] = now.code[i] ? now.code[i] : before.code[i] ? before.code[i] : after.code[i];
    if (states.code[i]) continue;
    set(states.position_m, n, i, gcrs_from_teme[1] * get<Teme>(now.position_m, k, i));
    set(states.velocity_m_per_s, n, i, gcrs_from_teme[1] * get<Teme>(now.velocity_m_per_s, k, i));
    const Vec<Gcrs> path = gcrs_from_teme[2] * get<Teme>(after.position_m, k, i) -
                           gcrs_from_teme[0] * get<Teme>(before.position_m, k, i);
    set(states.slope_m_per_s, n, i, path / span_s);
  }
}

void StateSource::add_models(const Instant& now, ObjectStates& states) const {
  for (std::size_t k = 0; k < population_.models.size(); ++k) {
    const std::size_t i = population_.elements.size() + k;
    const Placed path = now.placed(population_.models[k]);
    states.code[i] = path.code;
    if (path.code) continue;
    set(states.position_m, states.count, i, path.state.position_m);
    set(states.slope_m_per_s, states.count, i, path.state.velocity_m_per_s);
    const auto state = in_gcrs(state_at(population_.models[k], now.tai), now.earth, now.time);
    set(states.velocity_m_per_s, states.count, i, state.velocity_m_per_s);
  }
}

void StateSource::add_attitudes(const Instant (&instants)[3], ObjectStates& states) const {
  std::array<Vec<Gcrs>, 3> sun_m;
  for (std::size_t j = 0; j < 3; ++j) sun_m[j] = solar_system(clock_.tt(instants[j].time)).sun_m;
  const std::size_t m = population_.attitudes.size(), k = batch_.size();
  states.gcrs_from_body.assign(4 * m, 0.0);
  states.attitude_rate_rad_per_s.assign(3 * m, 0.0);
  for (std::size_t a = 0; a < m; ++a) {
    const std::size_t object = population_.attitudes[a].object;
    const Attitude& model = population_.attitudes[a].model;
    states.attitude_object.push_back(static_cast<std::uint32_t>(object));
    if (states.code[object]) continue;
    const auto scene = [&](std::size_t j) -> std::optional<AttitudeScene> {
      const Placed placed = object < k ? instants[j].of_sgp4(object)
                                       : instants[j].placed(population_.models[object - k]);
      if (placed.code) return std::nullopt;
      return AttitudeScene{instants[j].time.seconds(), placed.state.position_m,
                           placed.state.velocity_m_per_s, sun_m[j]};
    };
    // At an end of a trajectory or a table the rate is a one-sided difference.
    const AttitudeScene now = *scene(1);
    const auto within = [&](const std::optional<AttitudeScene>& s) {
      const auto* table = std::get_if<TableAttitude>(&model);
      return s &&
             (!table || (s->time_s >= table->time_s.front() && s->time_s <= table->time_s.back()));
    };
    const auto before = scene(0), after = scene(2);
    const AttitudeState state =
        attitude_state(model, within(before) ? *before : now, now, within(after) ? *after : now);
    const Quaternion& q = state.gcrs_from_body;
    const double components[4] = {q.w, q.x, q.y, q.z};
    for (std::size_t c = 0; c < 4; ++c) states.gcrs_from_body[c * m + a] = components[c];
    set(states.attitude_rate_rad_per_s, m, a, state.rate_rad_per_s);
  }
}

std::string StateSource::why_absent(std::size_t i, const ObjectStates& states) const {
  const auto& object = population_.roster.objects[i];
  std::string text = object.name + " (" + std::to_string(object.catalogue_number) +
                     ") is not in the scene at " + format_utc(clock_.utc(states.time)) + ": ";
  const std::size_t k = batch_.size();
  if (i < k) {
    const auto code = static_cast<Sgp4Code>(states.code[i]);
    return text + "SGP4 code " + std::to_string(states.code[i]) + ", " +
           std::string(describe(code));
  }
  text += describe(static_cast<MotionCode>(states.code[i]));
  if (const auto* path = std::get_if<Trajectory>(&population_.models[i - k]))
    text += ", " + path->source + ": " + span_text(*path);
  return text;
}

}  // namespace dmise
