#pragma once
#include <cstdint>
#include <vector>

#include "core/base/sim_time.h"
#include "core/config/scenario.h"
#include "core/detector/noise/detector_effect.h"

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

/// Returns how long after the first row the last one is exposed.
SimTime last_row_delay(const SensorConfig& sensor);

/// Returns an exposure as it is commanded, by the sensor's clock.
inline FrameTimes frame_times(const SensorConfig& sensor, std::uint32_t frame) {
  const SimTime length = sim_seconds(sensor.exposure_s);
  const SimTime start{sim_seconds(sensor.first_exposure_s).ns +
                      std::int64_t(frame - 1) * sim_seconds(sensor.cadence_s).ns};
  return {frame, start, {start.ns + length.ns / 2}, start + length};
}

/// Returns an exposure as the detector's effects see it.
Exposure exposure_of(const SensorConfig& sensor, const FrameTimes& times, std::uint64_t seed);

/// The times that a frame is made from: those of its exposure as it is commanded, and as the
/// sensor's clock may have it.
struct ExposureSpan {
  SimTime start, end;
};
ExposureSpan exposure_span(const SensorConfig& sensor, const FrameTimes& commanded);
ExposureSpan exposure_span(const SensorConfig& sensor, std::uint32_t frame);

/// Returns the number of exposures that end within the run, whatever the sensor's clock.
std::uint32_t frames_within(const SensorConfig& sensor, SimTime duration);

/// `count` of the frames 1 to `frames`, including the first and the last.
std::vector<std::uint32_t> evenly(std::uint32_t frames, std::uint32_t count);

}  // namespace dmise
