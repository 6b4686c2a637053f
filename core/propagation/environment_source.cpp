#include "core/propagation/environment_source.h"

#include <cmath>

#include "core/base/units.h"
#include "core/frames/earth_orientation.h"
#include "core/orbit/interpolation.h"
#include "core/propagation/run_on.h"
#include "core/sky/places/sun_moon.h"

namespace dmise {
namespace {

constexpr std::int64_t minute_ns = 60'000'000'000;
constexpr double turbulence_wavelength_m = 500 * nm;

/// Ticks between two states, at least one.
Tick period(double every_s, SimTime tick_length) {
  const double ticks = std::ceil(every_s / tick_length.seconds() - 1e-9);
  return std::max<Tick>(1, Tick(ticks));
}

}  // namespace

EnvironmentSource::EnvironmentSource(const Scenario& scenario,
                                     const std::vector<SensorConfig>& sensors, Clock clock)
    : tick_length_(scenario.tick),
      common_period_(period(scenario.environment.common_every_s, scenario.tick)),
      site_period_(period(scenario.environment.site_every_s, scenario.tick)),
      sensors_propagate_(scenario.network.sensors_propagate),
      clock_(std::move(clock)) {
  for (const auto& sensor : sensors) {
    if (!std::holds_alternative<SiteConfig>(sensor.place)) continue;
    ground_sensors_.push_back(sensor);
    if (const auto& t = sensor.atmosphere.turbulence)
      turbulence_[sensor.name] = turbulence(t->profile, turbulence_wavelength_m, 1.0, t->wind);
  }
}

EnvironmentState environment_at(const Clock& clock, Tick tick, SimTime time) {
  const Tt tt = clock.tt(time);
  const auto bodies = solar_system(tt);
  return {.tick = tick,
          .time = time,
          .earth = earth_orientation(clock, time),
          .sun_m = bodies.sun_m,
          .moon_m = bodies.moon_m,
          .earth_barycentric_m = bodies.earth_barycentric_m,
          .earth_velocity_m_per_s = bodies.earth_velocity_m_per_s,
          .tt_jd1 = tt.jd1,
          .tt_jd2 = tt.jd2,
          .moon_velocity_m_per_s = bodies.moon_velocity_m_per_s,
          .earth_beside = std::nullopt};
}

EnvironmentState EnvironmentByMinutes::at(Tick tick, SimTime time) {
  const SimTime whole{time.ns - time.ns % minute_ns};
  if (!minute_ || minute_->time != whole) minute_ = environment_at(clock_, 0, whole);
  EnvironmentState state = run_on(*minute_, time);
  state.tick = tick;
  state.earth.run_on(time);
  return state;
}

EnvironmentState EnvironmentSource::common(Tick tick) const {
  const SimTime time{tick * tick_length_.ns};
  EnvironmentState state = environment_at(clock_, tick, time);
  if (sensors_propagate_)
    state.earth_beside = {earth_orientation(clock_, {time.ns - slope_half_step_ns}),
                          earth_orientation(clock_, {time.ns + slope_half_step_ns})};
  return state;
}

SiteState EnvironmentSource::site(const SensorConfig& sensor, Tick tick) const {
  const SimTime time{tick * tick_length_.ns};
  const Weather air =
      sensor.weather.air.value_or(standard_weather(std::get<SiteConfig>(sensor.place).height_m));
  SiteState state{.tick = tick,
                  .time = time,
                  .sensor = sensor.name,
                  .extinction_mag_per_airmass =
                      sensor.atmosphere.extinction_mag_per_airmass.at_or_end(550 * nm),
                  .pressure_hpa = air.pressure_hpa,
                  .temperature_c = air.temperature_c,
                  .humidity = air.humidity};
  if (sensor.weather.clouds)
    state.cloud_transmission =
        CloudMap(*sensor.weather.clouds).transmission({0, 0, 1}, time.seconds());
  if (const auto found = turbulence_.find(sensor.name); found != turbulence_.end()) {
    const Turbulence& t = found->second;
    state.r0_m = t.r0_m;
    state.isoplanatic_angle_rad = t.isoplanatic_angle_rad;
    state.tau0_s = t.tau0_s;
    state.turbulence_m_per_s = t.wind_m_per_s;
  }
  return state;
}

}  // namespace dmise
