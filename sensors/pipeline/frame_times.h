#pragma once
#include <cstdint>

#include "core/base/sim_time.h"
#include "core/config/scenario.h"

namespace dmise {

/// One opening of the shutter.
struct FrameTimes {
  std::uint32_t frame = 1;  // counts from 1
  SimTime start, middle, end;

  SimTime at(double fraction) const {
    return {start.ns + std::llround(fraction * double(end.ns - start.ns))};
  }
  double seconds() const { return (end - start).seconds(); }
};

inline FrameTimes frame_times(const SensorConfig& sensor, std::uint32_t frame) {
  const SimTime length = sim_seconds(sensor.exposure_s);
  const SimTime start{sim_seconds(sensor.first_exposure_s).ns +
                      std::int64_t(frame - 1) * sim_seconds(sensor.cadence_s).ns};
  return {frame, start, {start.ns + length.ns / 2}, start + length};
}

/// Exposures that end within the run.
inline std::uint32_t frames_within(const SensorConfig& sensor, SimTime duration) {
  std::uint32_t frame = 0;
  const std::int64_t room = duration.ns - frame_times(sensor, 1).end.ns;
  if (room >= 0) frame = static_cast<std::uint32_t>(room / sim_seconds(sensor.cadence_s).ns + 1);
  return frame;
}

}  // namespace dmise
