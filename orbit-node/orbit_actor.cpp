#include "orbit-node/orbit_actor.h"

#include <cmath>
#include <map>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/config/yaml_reader.h"
#include "core/frames/earth_orientation.h"
#include "core/orbit/catalogue.h"
#include "core/orbit/catalogue_report.h"
#include "core/orbit/interpolation.h"
#include "core/orbit/object_facts.h"

namespace dmise {
namespace {

constexpr std::int64_t half_step_ns = std::int64_t(slope_half_step_s * 1e9);

bool wanted(const ObjectSource& source, const MeanElements& elements) {
  if (source.only.empty()) return true;
  const std::string number = std::to_string(elements.catalogue_number);
  for (const auto& name : source.only)
    if (name == number || name == elements.name) return true;
  return false;
}

void require_all_found(const ObjectSource& source, const std::vector<MeanElements>& elements) {
  for (const auto& name : source.only) {
    bool found = false;
    std::vector<std::string> names;
    for (const auto& e : elements) {
      found = found || name == e.name || name == std::to_string(e.catalogue_number);
      names.push_back(e.name);
    }
    if (found) continue;
    const std::string hint = nearest_name(name, names);
    throw ConfigError(source.path + ": no object is named or numbered " + name +
                      (hint.empty() ? "" : ", did you mean " + hint + "?"));
  }
}

}  // namespace

ObjectPopulation load_objects(const Scenario& scenario, const Clock& clock) {
  ObjectPopulation population;
  std::map<std::uint32_t, bool> taken;
  const Utc start = clock.utc({0});
  int stale = 0;
  for (const auto& source : scenario.objects) {
    const auto catalogue = read_catalogue(source.path);
    if (catalogue.elements.empty())
      throw ConfigError(source.path + ": no element set could be read" +
                        (catalogue.refused.empty()
                             ? std::string()
                             : ": " + catalogue.describe(catalogue.refused[0])));
    require_all_found(source, catalogue.elements);
    const DiffuseSphere unknown{source.radius_m, source.albedo};
    ObjectFactsFile facts;
    if (!source.facts_path.empty()) facts = read_object_facts(source.facts_path);
    for (const auto& problem : facts.refused)
      population.notes.push_back(source.facts_path + ":" + std::to_string(problem.line) + ": " +
                                 problem.reason + " (left out)");
    for (const auto& problem : catalogue.refused)
      population.notes.push_back(catalogue.describe(problem) + " (left out)");
    for (const auto& problem : catalogue.warnings)
      population.notes.push_back(catalogue.describe(problem));
    for (const auto& e : catalogue.elements) {
      if (!wanted(source, e) || !taken.emplace(e.catalogue_number, true).second) continue;
      const double age_days = element_age_days(e, start);
      stale += std::abs(age_days) > stale_after_days;
      const auto known = facts.facts.find(e.catalogue_number);
      const DiffuseSphere sphere = known == facts.facts.end()
                                       ? unknown
                                       : sphere_of(known->second, unknown).sphere;
      population.roster.objects.push_back({.catalogue_number = e.catalogue_number,
                                           .name = e.name,
                                           .designator = e.designator,
                                           .geometry = sphere,
                                           .element_age_s = age_days * day_s});
      population.elements.push_back(e);
    }
  }
  if (stale > 0)
    population.notes.push_back(std::to_string(stale) + " of " +
                               std::to_string(population.elements.size()) +
                               " objects have elements more than 30 days from the start of the run");
  return population;
}

ObjectStates states_at(const Sgp4Batch& batch, const Clock& clock, Tick tick, SimTime time,
                       Threads& threads) {
  const std::size_t n = batch.size();
  ObjectStates states{.tick = tick, .time = time, .count = n};
  states.position_m.resize(3 * n);
  states.slope_m_per_s.resize(3 * n);
  states.velocity_m_per_s.resize(3 * n);
  states.code.resize(n);
  std::vector<double> before(3 * n), after(3 * n), unused(3 * n);
  std::vector<std::uint8_t> code_before(n), code_after(n);
  const auto propagate = [&](SimTime t, std::vector<double>& position, std::vector<double>& velocity,
                             std::vector<std::uint8_t>& code) {
    const Utc utc = clock.utc(t);
    batch.propagate(utc.jd1, utc.jd2, position, velocity, code, &threads);
    const auto gcrs_from_teme = earth_orientation(clock, t).gcrs_from_teme(t);
    const auto turn = [&](std::vector<double>& v, std::size_t i) {
      const Vec<Gcrs> g = gcrs_from_teme * Vec<Teme>{v[i], v[n + i], v[2 * n + i]};
      v[i] = g.x;
      v[n + i] = g.y;
      v[2 * n + i] = g.z;
    };
    for (std::size_t i = 0; i < n; ++i) {
      turn(position, i);
      turn(velocity, i);
    }
  };
  propagate({time.ns - half_step_ns}, before, unused, code_before);
  propagate({time.ns + half_step_ns}, after, unused, code_after);
  propagate(time, states.position_m, states.velocity_m_per_s, states.code);
  const double span_s = 2e-9 * half_step_ns;
  for (std::size_t i = 0; i < n; ++i) {
    if (states.code[i] == 0) states.code[i] = code_before[i] ? code_before[i] : code_after[i];
    for (std::size_t k = i; k < 3 * n; k += n) {
      if (states.code[i]) states.position_m[k] = states.velocity_m_per_s[k] = 0.0;
      states.slope_m_per_s[k] = states.code[i] ? 0.0 : (after[k] - before[k]) / span_s;
    }
  }
  return states;
}

OrbitActor::OrbitActor(const Scenario& scenario, Clock clock, Threads& threads)
    : tick_length_(scenario.tick),
      clock_(std::move(clock)),
      threads_(threads),
      population_(load_objects(scenario, clock_)),
      batch_(population_.elements) {}

std::vector<Message> OrbitActor::step(Tick tick, std::span<const Message>) {
  std::vector<Message> messages;
  if (tick == 0)
    messages.push_back({objects_topic, tick, std::make_shared<State>(population_.roster)});
  messages.push_back({objects_topic, tick,
                      std::make_shared<State>(states_at(batch_, clock_, tick,
                                                        {tick * tick_length_.ns}, threads_))});
  ++steps_;
  return messages;
}

}  // namespace dmise
