#include "sensors/objects/state_window_source.h"

#include <algorithm>
#include <cmath>

#include "core/orbit/interpolation.h"

namespace dmise {
namespace {

/// Knots of an exposure's states are no farther apart: cubic interpolation is good to 4 m.
constexpr std::int64_t longest_between_ns = 60'000'000'000;

/// `every_s` in ticks, as a multiple of `period`.
Tick thinned(Tick period, double every_s, SimTime tick) {
  return period * std::max<Tick>(1, Tick(every_s / (double(period) * tick.seconds())));
}

}  // namespace

StateWindowSource::StateWindowSource(const Scenario& scenario, const SensorConfig& sensor,
                                     const Clock& clock, double environment_every_s)
    : scenario_(scenario),
      sensor_(sensor),
      environment_(scenario, {sensor}, clock),
      environment_period_(
          thinned(environment_.common_period(), environment_every_s, scenario.tick)) {}

KnotTicks StateWindowSource::ticks_of(const FrameTimes& commanded) const {
  const ExposureSpan exposure = exposure_span(sensor_, commanded);
  const Tick last_tick = scenario_.last_tick();
  const Tick before = std::max<Tick>(0, exposure.start.ns / scenario_.tick.ns - 1);
  return {knot_ticks(scenario_.interpolation, before, last_tick).first,
          tick_needed(scenario_.interpolation, exposure.end, scenario_.tick, last_tick)};
}

StateWindow StateWindowSource::around(const FrameTimes& commanded,
                                      const ObjectPopulation& population,
                                      const StateSource& states) const {
  return between(ticks_of(commanded), exposure_span(sensor_, commanded).end, population, states);
}

StateWindow StateWindowSource::until(const FrameTimes& commanded,
                                     const ObjectPopulation& population,
                                     const StateSource& states) const {
  return between({0, ticks_of(commanded).last}, exposure_span(sensor_, commanded).end, population,
                 states);
}

StateWindow StateWindowSource::between(KnotTicks ticks, SimTime end,
                                       const ObjectPopulation& population,
                                       const StateSource& states) const {
  StateWindow window(scenario_.interpolation, scenario_.last_tick());
  window.add(std::make_shared<const ObjectRoster>(population.roster));
  if (!population.roster.objects.empty())
    for (Tick tick = ticks.first; tick <= ticks.last; ++tick)
      window.add(std::make_shared<const ObjectStates>(states.at(tick, scenario_.time_of(tick))));
  // Those that were published last before the first tick, and all after it.
  const auto published = [&](Tick period, const auto& add) {
    for (Tick tick = ticks.first - ticks.first % period;
         tick <= ticks.last && scenario_.time_of(tick) <= end; tick += period)
      add(tick);
  };
  published(environment_period_, [&](Tick tick) {
    window.add(std::make_shared<const EnvironmentState>(environment_.common(tick)));
  });
  published(environment_.site_period(), [&](Tick tick) {
    for (const SensorConfig& sensor : environment_.ground_sensors())
      window.add(std::make_shared<const SiteState>(environment_.site(sensor, tick)));
  });
  return window;
}

StateWindow window_of_some(std::shared_ptr<const ObjectRoster> roster,
                           std::shared_ptr<const EnvironmentState> environment,
                           const EarthOrientation& earth, const ExposureSpan& span,
                           std::vector<std::uint32_t> objects, const StateSource& states) {
  StateWindow window;
  window.add(std::move(roster));
  window.add(std::move(environment));
  const Clock& clock = states.clock();
  const auto instant = [&](SimTime t) {
    return StateInstant{t, clock.tai(t), clock.utc(t), earth, earth.gcrs_from_teme(t)};
  };
  const std::int64_t length_ns = std::max<std::int64_t>(1, (span.end - span.start).ns);
  const std::int64_t parts = (length_ns + longest_between_ns - 1) / longest_between_ns;
  std::vector<ObjectStates> of_knots;
  for (Tick k = 0; k <= parts; ++k) {
    const SimTime t{span.start.ns + length_ns * k / parts};
    const StateInstants around{instant({t.ns - slope_half_step_ns}), instant(t),
                               instant({t.ns + slope_half_step_ns})};
    window.add_tick(k, t);
    of_knots.push_back(states.of_some(objects, k, around));
  }
  window.set_states(std::move(objects), std::move(of_knots));
  return window;
}

}  // namespace dmise
