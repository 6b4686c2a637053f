#include "sensors/objects/states_in_field.h"

#include <algorithm>
#include <mutex>

#include "core/effects/frame_effects.h"

namespace dmise {
namespace {

/// Time between propagations of whole catalogues; places in between are straight lines.
constexpr std::int64_t rough_every_ns = 120'000'000'000;

/// Greatest error of cubic interpolation over a tick [m]: h^4 / 384 of the fourth derivative, which
/// is below 1e-4 m/s^4 for whatever orbits the Earth.
double interpolation_error_m(double tick_s) { return 1e-4 * std::pow(tick_s, 4) / 384.0; }

}  // namespace

PropagatedObjects::PropagatedObjects(const ObjectRoster& roster, const std::vector<OwnObject>& own,
                                     Clock clock, const Ellipsoid& ellipsoid,
                                     const ObjectModels& models)
    : population(population_of(roster, own, ellipsoid, models)),
      from_catalogues(population.roster.objects.size() - own.size()),
      source(population, std::move(clock), threads) {}

std::shared_ptr<const PropagatedObjects> propagated_objects(
    const std::shared_ptr<const State>& roster, const std::vector<OwnObject>& own,
    const Clock& clock, const Ellipsoid& ellipsoid, const ObjectModels& models) {
  using Objects = std::weak_ptr<const PropagatedObjects>;
  static std::mutex mutex;
  static std::map<std::weak_ptr<const State>, Objects, std::owner_less<>> of_roster;
  const std::lock_guard lock(mutex);
  std::erase_if(of_roster, [](const auto& entry) { return entry.second.expired(); });
  Objects& known = of_roster[roster];
  auto objects = known.lock();
  if (!objects) {
    objects = std::make_shared<const PropagatedObjects>(std::get<ObjectRoster>(*roster), own, clock,
                                                        ellipsoid, models);
    known = objects;
  }
  return objects;
}

StatesInField::StatesInField(std::shared_ptr<const PropagatedObjects> objects, SimTime tick_length)
    : objects_(std::move(objects)), tick_length_(tick_length) {}

const StateInstants& StatesInField::instants(const StateWindow& window, Tick tick) {
  const auto found = instants_.find(tick);
  if (found != instants_.end()) return found->second;
  const SimTime time{tick * tick_length_.ns};
  std::vector<EarthOrientation> published;
  if (const EnvironmentState* state = window.environment_of(time)) {
    published.push_back(state->earth);
    if (const auto& beside = state->earth_beside)
      published.insert(published.end(), beside->begin(), beside->end());
  }
  return instants_.emplace(tick, objects_->source.instants(time, published)).first->second;
}

RoughPlaces& StatesInField::rough_places(SimTime t) {
  const SimTime time{(t.ns + rough_every_ns / 2) / rough_every_ns * rough_every_ns};
  if (rough_ && rough_->time == time) return *rough_;
  const StateSource& source = objects_->source;
  const std::size_t n = source.elements().size();
  if (!rough_) rough_.emplace();
  rough_->time = time;
  rough_->longest_s = 0.5e-9 * double(rough_every_ns);
  rough_->gcrs_from_teme = earth_orientation(source.clock(), time).gcrs_from_teme(time);
  rough_->position_m.resize(3 * n);
  rough_->velocity_m_per_s.resize(3 * n);
  rough_->code.resize(n);
  rough_->shortlist.reset();
  rough_->count = objects_->from_catalogues;
  rough_->interpolation_error_m = interpolation_error_m(tick_length_.seconds());
  const Utc utc = source.clock().utc(time);
  source.elements().propagate(utc.jd1, utc.jd2, rough_->position_m, rough_->velocity_m_per_s,
                              rough_->code);
  return *rough_;
}

StateWindow StatesInField::around(const StateWindow& window, const SensorConfig& sensor,
                                  const FrameTimes& commanded, std::uint64_t seed) {
  StateWindow seen = window;
  const ExposureSpan span = exposure_span(sensor, commanded);
  const KnotTicks ticks = window.ticks_for(span.start, span.end);
  std::erase_if(instants_, [&](const auto& known) { return known.first < ticks.first; });
  const auto know = [&](std::vector<std::uint32_t> objects) {
    std::sort(objects.begin(), objects.end());
    objects.erase(std::unique(objects.begin(), objects.end()), objects.end());
    std::vector<ObjectStates> states;
    for (Tick tick = ticks.first; tick <= ticks.last && !objects.empty(); ++tick)
      states.push_back(objects_->source.of_some(objects, tick, instants(window, tick), &told_));
    seen.set_states(std::move(objects), std::move(states));
  };
  const auto needed = needed_objects(sensor, window.roster());
  std::vector<std::uint32_t> objects(needed.begin(), needed.end());
  know(objects);
  if (!sensor.effects.has(SpaceObjects::facts)) return seen;
  {
    const View view(sensor, commanded, seen, seed);
    const auto candidates = may_be_in_field(view, rough_places(view.times().middle));
    objects.insert(objects.end(), candidates.begin(), candidates.end());
  }
  const auto count = std::uint32_t(window.object_count());
  for (auto own = std::uint32_t(objects_->from_catalogues); own < count; ++own)
    objects.push_back(own);
  know(std::move(objects));
  return seen;
}

}  // namespace dmise
