#include "core/propagation/object_states.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "core/base/error.h"
#include "core/frames/oblate_earth.h"
#include "core/orbit/interpolation.h"
#include "core/sim/columns.h"
#include "core/sky/places/sun_moon.h"
#include "core/time/iso8601.h"

namespace dmise {
namespace {

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

Placed without_state(MotionCode code) { return {{}, std::uint8_t(code)}; }

/// State from a model other than SGP4; its velocity is the slope of the position.
Placed placed(const MotionModel& model, const StateInstant& at, const Ellipsoid& ellipsoid) {
  if (const auto* path = std::get_if<Trajectory>(&model); path && !covers(*path, at.tai))
    return without_state(MotionCode::outside_span);
  try {
    const auto state = in_gcrs(path_at(model, at.tai), at.earth, at.time);
    if (is_fixed(model) || is_above_ground(state.position_m, at.earth, ellipsoid))
      return {state, 0};
  } catch (const Error&) {  // a path through the Earth's centre
  }
  return without_state(MotionCode::underground);
}

/// State of an object that a node moves, on the straight line through what it told of a tick.
Placed told_place(const ObjectStates* told, std::size_t i, const StateInstant& at,
                  const Ellipsoid& ellipsoid) {
  if (!told) return without_state(MotionCode::untold);
  if (told->code[i] != 0) return {{}, told->code[i]};
  const Vec<Gcrs> slope_m_per_s = told->slope(i);
  const double dt_s = (at.time - told->time).seconds();
  const Vec<Gcrs> position_m = told->position(i) + slope_m_per_s * dt_s;
  if (!is_above_ground(position_m, at.earth, ellipsoid))
    return without_state(MotionCode::underground);
  return {{position_m, slope_m_per_s}, 0};
}

/// An object that its node does not turn at this tick is not in the scene.
void take_out(ObjectStates& states, std::size_t k) {
  for (auto* numbers : {&states.position_m, &states.slope_m_per_s, &states.velocity_m_per_s})
    set_column(*numbers, states.count, k, Vec<Gcrs>{});
  states.code[k] = std::uint8_t(MotionCode::untold);
}

/// States of SGP4 at one instant in TEME: 3 x elements.
struct Sgp4States {
  std::vector<double> position_m, velocity_m_per_s;
  std::vector<std::uint8_t> code;

  void resize(std::size_t n) {
    position_m.resize(3 * n);
    velocity_m_per_s.resize(3 * n);
    code.resize(n);
  }
  Placed placed(std::size_t k, const StateInstant& at) const {
    const std::size_t n = code.size();
    return {{at.gcrs_from_teme * get<Teme>(position_m, n, k),
             at.gcrs_from_teme * get<Teme>(velocity_m_per_s, n, k)},
            code[k]};
  }
};

}  // namespace

/// The objects wanted at the instants of one time.
struct StateSource::Scene {
  const ObjectPopulation& population;
  const StateInstants& instants;
  Tick tick = 0;
  const ActorStates* told = nullptr;
  bool all = true;
  std::span<const std::uint32_t> objects;  // unless all
  std::size_t count = 0, with_elements = 0;
  std::array<Sgp4States, 3> sgp4;

  std::size_t object(std::size_t k) const { return all ? k : objects[k]; }

  const MotionModel& model(std::size_t k) const {
    return population.models[object(k) - population.elements.size()];
  }

  /// What the node of a motion or an attitude says; null if that is not known.
  template <class ByNode>
  const ObjectStates* told_by(const ByNode& by_node) const {
    return told ? told->of(by_node.node, tick, by_node.place) : nullptr;
  }

  Placed placed_at(std::size_t k, std::size_t instant) const {
    const StateInstant& at = instants[instant];
    if (k < with_elements) return sgp4[instant].placed(k, at);
    if (const auto* by_node = std::get_if<NodeMotion>(&model(k)))
      return told_place(told_by(*by_node), by_node->place, at, population.ellipsoid);
    return placed(model(k), at, population.ellipsoid);
  }

  /// The velocity of an object without elements that has a state.
  Vec<Gcrs> velocity_of(std::size_t k) const {
    if (const auto* by_node = std::get_if<NodeMotion>(&model(k))) {
      const ObjectStates& states = *told_by(*by_node);
      return get<Gcrs>(states.velocity_m_per_s, states.count, by_node->place);
    }
    const StateInstant& now = instants[1];
    return in_gcrs(state_at(model(k), now.tai), now.earth, now.time).velocity_m_per_s;
  }

  /// The albedo that a node tells of an object without elements that has a state.
  std::optional<double> albedo_of(std::size_t k) const {
    const auto* by_node = std::get_if<NodeMotion>(&model(k));
    return by_node ? told_by(*by_node)->albedo_of(by_node->place) : std::nullopt;
  }

  /// Empty if the attitude is a node's, which does not tell it.
  std::optional<AttitudeState> attitude_of(std::size_t k, const Attitude& attitude,
                                           const std::array<Vec<Gcrs>, 3>& sun_m) const {
    if (const auto* by_node = std::get_if<NodeAttitude>(&attitude)) {
      const ObjectStates* states = told_by(*by_node);
      return states ? states->attitude(by_node->place) : std::nullopt;
    }
    const auto scene = [&](std::size_t j) -> std::optional<AttitudeScene> {
      const Placed there = placed_at(k, j);
      if (there.code) return std::nullopt;
      return AttitudeScene{instants[j].time.seconds(), there.state.position_m,
                           there.state.velocity_m_per_s, sun_m[j]};
    };
    // At an end of a trajectory or a table the rate is a one-sided difference.
    const AttitudeScene now = *scene(1);
    const auto* table = std::get_if<TableAttitude>(&attitude);
    const auto within = [&](const std::optional<AttitudeScene>& s) {
      return s &&
             (!table || (s->time_s >= table->time_s.front() && s->time_s <= table->time_s.back()));
    };
    const auto before = scene(0), after = scene(2);
    return attitude_state(attitude, within(before) ? *before : now, now,
                          within(after) ? *after : now);
  }
};

StateSource::StateSource(const ObjectPopulation& population, Clock clock, Threads& threads)
    : population_(population),
      clock_(std::move(clock)),
      threads_(threads),
      batch_(population.elements) {}

StateInstants StateSource::instants(SimTime time, std::span<const EarthOrientation> known) const {
  const auto at = [&](SimTime t) {
    const auto of_t =
        std::find_if(known.begin(), known.end(), [&](const auto& e) { return e.time == t; });
    const EarthOrientation earth = of_t != known.end() ? *of_t : earth_orientation(clock_, t);
    return StateInstant{t, clock_.tai(t), clock_.utc(t), earth, earth.gcrs_from_teme(t)};
  };
  return {at({time.ns - slope_half_step_ns}), at(time), at({time.ns + slope_half_step_ns})};
}

ObjectStates StateSource::at(Tick tick, SimTime time, const ActorStates* told) const {
  const StateInstants moments = instants(time);
  Scene scene{.population = population_,
              .instants = moments,
              .tick = tick,
              .told = told,
              .count = population_.roster.objects.size(),
              .with_elements = batch_.size()};
  for (std::size_t j = 0; j < 3 && scene.with_elements > 0; ++j) {
    Sgp4States& s = scene.sgp4[j];
    s.resize(scene.with_elements);
    batch_.propagate(moments[j].utc.jd1, moments[j].utc.jd2, s.position_m, s.velocity_m_per_s,
                     s.code, &threads_);
  }
  return states_of(scene);
}

ObjectStates StateSource::of_some(std::span<const std::uint32_t> objects, Tick tick,
                                  const StateInstants& instants, const ActorStates* told) const {
  const auto others = std::lower_bound(objects.begin(), objects.end(), batch_.size());
  Scene scene{.population = population_,
              .instants = instants,
              .tick = tick,
              .told = told,
              .all = false,
              .objects = objects,
              .count = objects.size(),
              .with_elements = std::size_t(others - objects.begin())};
  for (std::size_t j = 0; j < 3; ++j) {
    Sgp4States& s = scene.sgp4[j];
    s.resize(scene.with_elements);
    batch_.propagate_some(objects.first(scene.with_elements), instants[j].utc.jd1,
                          instants[j].utc.jd2, s.position_m, s.velocity_m_per_s, s.code);
  }
  return states_of(scene);
}

ObjectStates StateSource::states_of(const Scene& scene) const {
  ObjectStates states{.tick = scene.tick, .time = scene.instants[1].time, .count = scene.count};
  for (auto* numbers : {&states.position_m, &states.slope_m_per_s, &states.velocity_m_per_s})
    numbers->assign(3 * scene.count, 0.0);
  states.code.assign(scene.count, 0);
  if (scene.with_elements > 0) add_sgp4(scene, states);
  add_models(scene, states);
  if (!population_.attitudes.empty()) add_attitudes(scene, states);
  return states;
}

void StateSource::add_sgp4(const Scene& scene, ObjectStates& states) const {
  const std::size_t n = states.count, k = scene.with_elements;
  const auto& [before, now, after] = scene.sgp4;
  const auto& at = scene.instants;
  const double span_s = 2e-9 * slope_half_step_ns;
  for (std::size_t i = 0; i < k; ++i) {
    states.code[i] = now.code[i] ? now.code[i] : before.code[i] ? before.code[i] : after.code[i];
    if (states.code[i]) continue;
    set_column(states.position_m, n, i, at[1].gcrs_from_teme * get<Teme>(now.position_m, k, i));
    set_column(states.velocity_m_per_s, n, i,
               at[1].gcrs_from_teme * get<Teme>(now.velocity_m_per_s, k, i));
    const Vec<Gcrs> path = at[2].gcrs_from_teme * get<Teme>(after.position_m, k, i) -
                           at[0].gcrs_from_teme * get<Teme>(before.position_m, k, i);
    set_column(states.slope_m_per_s, n, i, path / span_s);
  }
}

void StateSource::add_models(const Scene& scene, ObjectStates& states) const {
  for (std::size_t k = scene.with_elements; k < scene.count; ++k) {
    const Placed path = scene.placed_at(k, 1);
    states.code[k] = path.code;
    if (path.code) continue;
    set_column(states.position_m, states.count, k, path.state.position_m);
    set_column(states.slope_m_per_s, states.count, k, path.state.velocity_m_per_s);
    set_column(states.velocity_m_per_s, states.count, k, scene.velocity_of(k));
    if (const auto albedo = scene.albedo_of(k)) {
      states.albedo.resize(states.count, roster_albedo);
      states.albedo[k] = *albedo;
    }
  }
}

void StateSource::add_attitudes(const Scene& wanted, ObjectStates& states) const {
  struct Turning {
    std::size_t k;
    const Attitude& model;
  };
  std::vector<Turning> turning;
  for (const ObjectAttitude& attitude : population_.attitudes) {
    const auto& objects = wanted.objects;
    const auto place = std::lower_bound(objects.begin(), objects.end(), attitude.object);
    if (wanted.all)
      turning.push_back({attitude.object, attitude.model});
    else if (place != objects.end() && *place == attitude.object)
      turning.push_back({std::size_t(place - objects.begin()), attitude.model});
  }
  if (turning.empty()) return;
  const StateInstants& instants = wanted.instants;
  std::array<Vec<Gcrs>, 3> sun_m;
  for (std::size_t j = 0; j < 3; ++j) sun_m[j] = solar_system(clock_.tt(instants[j].time)).sun_m;
  const std::size_t m = turning.size();
  states.gcrs_from_body.assign(4 * m, 0.0);
  states.attitude_rate_rad_per_s.assign(3 * m, 0.0);
  for (std::size_t a = 0; a < m; ++a) {
    const auto& [k, model] = turning[a];
    states.attitude_object.push_back(static_cast<std::uint32_t>(k));
    if (states.code[k]) continue;
    const auto state = wanted.attitude_of(k, model, sun_m);
    if (!state) {
      take_out(states, k);
      continue;
    }
    const Quaternion& q = state->gcrs_from_body;
    set_column(states.gcrs_from_body, m, a, {q.w, q.x, q.y, q.z});
    set_column(states.attitude_rate_rad_per_s, m, a, state->rate_rad_per_s);
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
