#include "core/instrument/clock_error.h"

#include <gtest/gtest.h>

#include "core/effects/plan_facts.h"
#include "core/instrument/instrument.h"

namespace dmise {
namespace {

ClockError clock_of(double offset_s, double drift, double rms_s = 0.0) {
  ClockError clock;
  clock.offset_s = offset_s;
  clock.drift = drift;
  clock.clock_rms_s = rms_s;
  return clock;
}

// A clock that is ahead reads a time before it is: the exposure begins early.
TEST(ClockError, AheadMeansEarly) {
  EXPECT_EQ(clock_of(0.25, 0).true_time(sim_seconds(10), 0.0), sim_seconds(9.75));
  EXPECT_EQ(clock_of(-0.25, 0).true_time(sim_seconds(10), 0.0), sim_seconds(10.25));
  EXPECT_EQ(clock_of(0.25, 0).true_time(sim_seconds(10), 0.05), sim_seconds(9.7));
}

// 100 ppm over 1000 s are 0.1 s; of the reading, to which the exposure is commanded, 1e-4 less.
TEST(ClockError, DriftsFromTheStartOfTheRun) {
  EXPECT_EQ(clock_of(0, 1e-4).reading(sim_seconds(1000), 0.0), sim_seconds(1000.1));
  EXPECT_EQ(clock_of(0, 1e-4).true_time(sim_seconds(1000), 0.0).ns, 999'900'009'999);
}

// Ten years are 3e17 ns, more than a double has digits for.
TEST(ClockError, KeepsTheNanosecondOverTenYears) {
  const ClockError clock = clock_of(0.5, 1e-9, 0.1);
  for (const std::int64_t ns : {0LL, 315'576'000'000'000'001LL}) {
    const SimTime truly = clock.true_time({ns}, 0.03);
    EXPECT_NEAR(double(clock.reading(truly, 0.03).ns - ns), 0.0, 1.0);
  }
}

TEST(ClockError, SurelyReadIsWhatTheLatestClockHasRead) {
  const SimTime end = sim_seconds(120);
  for (const ClockError& clock :
       {clock_of(0.3, 5e-4, 0.2), clock_of(-3, -5e-4, 0.0), clock_of(0, 0, 0.1)}) {
    const SimTime read = clock.surely_read_by(end);
    EXPECT_LE(clock.latest(read), end);
    EXPECT_GT(clock.latest(read + SimTime{10}), end);
    EXPECT_LE(clock.earliest(read), clock.latest(read));
  }
}

TEST(ClockError, StatesWhatLeavingItOutWouldCost) {
  PlanFacts facts;
  facts.pixel_rad = 1e-5;
  facts.fwhm_px = 2.0;  // pixels follow it
  facts.stars = 10;
  facts.star_rate_rad_per_s = 7.3e-5;
  facts.clock_error_s = 0.01;
  const ClockError clock = clock_of(0.01, 0);
  EXPECT_NEAR(clock.error(0, facts).position_px, 0.073, 0.01);
  facts.clock_error_s = 10.0;
  EXPECT_EQ(clock.error(0, facts), not_bounded);
  facts.clock_error_s = 0.0;
  EXPECT_EQ(clock.error(0, facts), ErrorBound{});
}

TEST(Instrument, WithoutTheEffectsThatAreOff) {
  Instrument both;
  both.offset_s = 1.0;
  both.bias_rad = {1e-3, 0, 0};
  EffectSet effects;
  EXPECT_EQ(acting_instrument(both, effects), both);
  effects.set(ClockError::facts, false);
  const Instrument acting = acting_instrument(both, effects);
  EXPECT_FALSE(acting.ClockError::applies());
  EXPECT_TRUE(acting.PointingError::applies());
}

}  // namespace
}  // namespace dmise
