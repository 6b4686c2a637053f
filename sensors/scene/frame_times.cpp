#include "sensors/scene/frame_times.h"

#include <algorithm>

namespace dmise {

SimTime last_row_delay(const SensorConfig& sensor) {
  if (!sensor.effects.has(RollingShutter::facts)) return {};
  const RollingShutter& shutter = sensor.camera.detector;
  return sim_seconds(shutter.last_row_delay_s(sensor.camera.optics.rows));
}

Exposure exposure_of(const SensorConfig& sensor, const FrameTimes& times, std::uint64_t seed) {
  return {.seed = seed,
          .sensor = sensor.name,
          .frame = times.frame,
          .exposure_s = times.seconds(),
          .idle_s = sensor.cadence_s - sensor.exposure_s};
}

ExposureSpan exposure_span(const SensorConfig& sensor, const FrameTimes& commanded) {
  const ClockError clock = acting_instrument(sensor.instrument, sensor.effects);
  const SimTime delay = last_row_delay(sensor);
  if (!clock.applies()) return {commanded.start, commanded.end + delay};
  return {std::min(commanded.start, clock.earliest(commanded.start)),
          std::max(commanded.end, clock.latest(commanded.end)) + delay};
}

ExposureSpan exposure_span(const SensorConfig& sensor, std::uint32_t frame) {
  return exposure_span(sensor, frame_times(sensor, frame));
}

std::uint32_t frames_within(const SensorConfig& sensor, SimTime duration) {
  const ClockError clock = acting_instrument(sensor.instrument, sensor.effects);
  if (clock.applies()) duration = std::min(duration, clock.surely_read_by(duration));
  const std::int64_t room = duration.ns - (frame_times(sensor, 1).end + last_row_delay(sensor)).ns;
  return room >= 0 ? static_cast<std::uint32_t>(room / sim_seconds(sensor.cadence_s).ns + 1) : 0;
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
