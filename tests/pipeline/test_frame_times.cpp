#include "sensors/scene/frame_times.h"

#include <gtest/gtest.h>

namespace dmise {
namespace {

SensorConfig every(double exposure_s, double cadence_s, double first_s = 0) {
  SensorConfig sensor;
  sensor.exposure_s = exposure_s;
  sensor.cadence_s = cadence_s;
  sensor.first_exposure_s = first_s;
  return sensor;
}

TEST(FrameTimes, FollowTheCadenceExactly) {
  const auto times = frame_times(every(0.1, 0.3, 1.0), 1'000'001);
  EXPECT_EQ(times.start.ns, 1'000'000'000 + 1'000'000LL * 300'000'000);
  EXPECT_EQ((times.end - times.start).ns, 100'000'000);
  EXPECT_EQ((times.middle - times.start).ns, 50'000'000);
}

TEST(FrameTimes, CountOnlyExposuresThatEndWithinTheRun) {
  EXPECT_EQ(frames_within(every(20, 30), sim_seconds(120)), 4u);
  EXPECT_EQ(frames_within(every(20, 30), sim_seconds(110)), 4u);
  EXPECT_EQ(frames_within(every(20, 30), sim_seconds(109.999)), 3u);
  EXPECT_EQ(frames_within(every(20, 30), sim_seconds(19)), 0u);
}

TEST(FrameTimes, OfAWrongClockCountExposuresWhoseLatestEndIsWithinTheRun) {
  SensorConfig sensor = every(2, 5);
  EXPECT_EQ(frames_within(sensor, sim_seconds(22)), 5u);
  sensor.instrument.offset_s = -0.5;
  EXPECT_EQ(frames_within(sensor, sim_seconds(22)), 4u);
  EXPECT_EQ(frames_within(sensor, sim_seconds(22.6)), 5u);
  const ExposureSpan span = exposure_span(sensor, 2);
  EXPECT_EQ(span.start, sim_seconds(5));
  EXPECT_EQ(span.end, sim_seconds(7.5));
  sensor.instrument.offset_s = 0.5;
  EXPECT_EQ(frames_within(sensor, sim_seconds(22)), 5u);
  EXPECT_EQ(exposure_span(sensor, 2).start, sim_seconds(4.5));
  sensor.effects.set(ClockError::facts, false);
  EXPECT_EQ(exposure_span(sensor, 2).start, sim_seconds(5));
}

}  // namespace
}  // namespace dmise
