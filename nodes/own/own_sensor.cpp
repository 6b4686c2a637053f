#include "nodes/own/own_sensor.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "core/detection/own_sightings.h"
#include "nodes/wire/state_codec.h"

namespace dmise {
namespace {

std::optional<MeasuredNumber> measured(bool is, double value, double sigma) {
  return is ? std::optional(MeasuredNumber{value, sigma}) : std::nullopt;
}

OwnSighting sighting_of(const v1::OwnNodeSighting& told, std::size_t index) {
  if (told.covariance_rad2_size() != 3)
    throw Error("sightings[" + std::to_string(index) +
                "].covariance_rad2: must be 3 numbers, got " +
                std::to_string(told.covariance_rad2_size()));
  return {.time = {told.time_ns()},
          .ra_rad = told.ra_rad(),
          .dec_rad = told.dec_rad(),
          .covariance_rad2 = {told.covariance_rad2(0), told.covariance_rad2(1),
                              told.covariance_rad2(2)},
          .magnitude = measured(told.has_magnitude(), told.magnitude(), told.magnitude_sigma()),
          .snr = told.snr(),
          .range_m = measured(told.has_range_m(), told.range_m(), told.range_sigma_m()),
          .range_rate_m_per_s = measured(told.has_range_rate_m_per_s(), told.range_rate_m_per_s(),
                                         told.range_rate_sigma_m_per_s())};
}

Observed observed_of(const v1::OwnNodeObserved& told) {
  Observed observed{.boresight_ra_rad = told.boresight_ra_rad(),
                    .boresight_dec_rad = told.boresight_dec_rad()};
  if (told.has_limiting_magnitude()) observed.limiting_magnitude = told.limiting_magnitude();
  for (const v1::OwnNodeSighting& one : told.sightings())
    observed.sightings.push_back(sighting_of(one, observed.sightings.size()));
  return observed;
}

v1::OwnNodeObserve request_of(const std::string& sensor, const ObserverExposure& exposure,
                              Tick tick) {
  v1::OwnNodeObserve request;
  request.set_sensor(sensor);
  request.set_frame(exposure.frame);
  request.set_tick(tick);
  request.set_start_ns(exposure.start.ns);
  request.set_middle_ns(exposure.middle.ns);
  request.set_end_ns(exposure.end.ns);
  const auto &r = exposure.position_m, &v = exposure.velocity_m_per_s;
  for (const double x : {r.x, r.y, r.z}) request.add_position_m(x);
  for (const double x : {v.x, v.y, v.z}) request.add_velocity_m_per_s(x);
  return request;
}

/// The frames after a request.
std::vector<std::string> world_of(const ObserverExposure& exposure) {
  std::vector<std::string> frames{encode(exposure.environment).payload};
  if (!exposure.roster) return frames;
  Encoded objects = encode(exposure.objects);
  frames.push_back(std::move(objects.payload));
  frames.push_back(std::move(objects.arrays));
  return frames;
}

FrameProgram::Beginning beginning_of(const v1::OwnNodeBegin& begin, const SensorConfig& sensor,
                                     const ObjectRoster* roster) {
  FrameProgram::Beginning beginning{begin};
  v1::OwnNodeObserving& observing = *beginning.begin.mutable_observing();
  describe_sensor(sensor, *observing.mutable_sensor());
  observing.set_truth(sensor.observing->truth);
  if (!roster) return beginning;
  Encoded encoded = encode(*roster);
  beginning.more = {std::move(encoded.payload), std::move(encoded.arrays)};
  return beginning;
}

std::optional<Observed> observe(OwnModel& program, const v1::OwnNodeObserve& request,
                                const ObserverExposure& exposure,
                                std::span<const std::string> world) {
  const std::vector<std::string_view> more(world.begin(), world.end());
  const auto told = program.observe(request, more);
  if (!told) return std::nullopt;
  if (told->frame() != exposure.frame)
    throw Error("it answers for frame " + std::to_string(told->frame()));
  Observed observed = observed_of(*told);
  check_observed(observed, exposure.start, exposure.end);
  return observed;
}

}  // namespace

ExposureObserver own_observer(const Scenario& scenario, const std::string& sensor,
                              const std::string& directory, OwnNodeSettings settings) {
  const SensorConfig& config = sensor_named(scenario, sensor);
  if (config.is_camera()) return {};
  const auto program =
      std::make_shared<FrameProgram>(scenario, config, directory, std::move(settings));
  return [program, &config](const ObserverExposure& exposure) -> std::optional<ObservedInExposure> {
    const auto request = request_of(config.name, exposure, program->tick_after(exposure.end));
    const std::vector<std::string> world = world_of(exposure);
    return program->ask(
        exposure.frame, exposure.end,
        [&] { return beginning_of(program->begin(), config, exposure.roster); },
        [&](OwnModel& started) { return observe(started, request, exposure, world); });
  };
}

}  // namespace dmise
