#include "nodes/environment/environment_actor.h"

#include "core/frames/earth_orientation.h"
#include "core/sky/sun_moon.h"

namespace dmise {

EnvironmentActor::EnvironmentActor(const Scenario& scenario, Clock clock)
    : tick_length_(scenario.tick), clock_(std::move(clock)) {
  for (const auto& sensor : scenario.sensors)
    skies_.push_back({sensor.name, sensor.sky_zenith_mag_per_arcsec2});
}

std::vector<Message> EnvironmentActor::step(Tick tick, std::span<const Message>) {
  const SimTime time{tick * tick_length_.ns};
  const Tt tt = clock_.tt(time);
  const auto bodies = solar_system(tt);
  EnvironmentState state{.tick = tick,
                         .time = time,
                         .earth = earth_orientation(clock_, time),
                         .sun_m = bodies.sun_m,
                         .moon_m = bodies.moon_m,
                         .earth_barycentric_m = bodies.earth_barycentric_m,
                         .earth_velocity_m_per_s = bodies.earth_velocity_m_per_s,
                         .tt_jd1 = tt.jd1,
                         .tt_jd2 = tt.jd2,
                         .skies = skies_};
  ++steps_;
  return {{environment_topic, tick, std::make_shared<State>(std::move(state))}};
}

}  // namespace dmise
