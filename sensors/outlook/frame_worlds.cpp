#include "sensors/outlook/frame_worlds.h"

#include <algorithm>

namespace dmise {
namespace {

/// Between environments within an exposure, at least. They run on by their rates: in that time the
/// Sun is off by 1.3 m, 1e-11 rad.
constexpr double environment_every_s = 0.1;

/// A scenario of this sensor alone with an environment at every tick.
Scenario alone(const Scenario& scenario, const SensorConfig& sensor) {
  Scenario one;
  one.tick = scenario.tick;
  one.environment = {.common_every_s = 0.0, .site_every_s = 0.0};
  one.sensors = {sensor};
  return one;
}

}  // namespace

ObjectPopulation only_these(const ObjectPopulation& all, const std::set<std::size_t>& indices) {
  ObjectPopulation some;
  some.ellipsoid = all.ellipsoid;
  for (const std::size_t i : indices) {
    for (const auto& attitude : all.attitudes)
      if (attitude.object == i)
        some.attitudes.push_back({some.roster.objects.size(), attitude.model});
    some.roster.objects.push_back(all.roster.objects[i]);
    if (i < all.elements.size())
      some.elements.push_back(all.elements[i]);
    else
      some.models.push_back(all.models[i - all.elements.size()]);
  }
  return some;
}

FrameWorlds::FrameWorlds(const Scenario& scenario, const SensorConfig& sensor, const Clock& clock)
    : scenario_(scenario), sensor_(sensor), environment_(alone(scenario, sensor), clock) {}

FrameWorlds::Ticks FrameWorlds::ticks_of(const FrameTimes& commanded) const {
  const ExposureSpan exposure = exposure_span(sensor_, commanded);
  const Tick last_tick = scenario_.last_tick();
  const Tick before = std::max<Tick>(0, exposure.start.ns / scenario_.tick.ns - 1);
  return {knot_ticks(scenario_.interpolation, before, last_tick).first,
          tick_needed(scenario_.interpolation, exposure.end, scenario_.tick, last_tick)};
}

World FrameWorlds::around(const FrameTimes& commanded, const ObjectPopulation& population,
                          const StateSource& source) {
  World world(scenario_.interpolation, scenario_.last_tick());
  world.add(std::make_shared<const ObjectRoster>(population.roster));
  const Ticks ticks = ticks_of(commanded);
  const SimTime end = exposure_span(sensor_, commanded).end;
  const Tick every = std::max<Tick>(1, Tick(environment_every_s / scenario_.tick.seconds()));
  for (Tick tick = ticks.first; tick <= ticks.last; ++tick) {
    if (!population.roster.objects.empty())
      world.add(std::make_shared<const ObjectStates>(source.at(tick, scenario_.time_of(tick))));
    if (scenario_.time_of(tick) > end || (tick - ticks.first) % every != 0) continue;
    for (const auto& message : environment_.step(tick, {})) world.add(message.state);
  }
  return world;
}

std::vector<std::uint32_t> evenly(std::uint32_t frames, std::uint32_t count) {
  count = std::min(count, frames);
  if (count == 0) return {};
  if (count == 1) return {1};
  std::vector<std::uint32_t> chosen;
  for (std::uint32_t k = 0; k < count; ++k)
    chosen.push_back(1 + std::uint32_t(std::uint64_t(frames - 1) * k / (count - 1)));
  return chosen;
}

}  // namespace dmise
