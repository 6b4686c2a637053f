#include <gtest/gtest.h>

#include <cmath>

#include "core/orbit/elements/epoch.h"
#include "tests/orbit/sgp4_orbits.h"

namespace dmise {
namespace {

using namespace test;

MeanElements low_orbit_of(const Utc& epoch) {
  MeanElements el = elements_with(0.001, 51.6, 15.5, 1e-5);
  el.epoch_jd1 = epoch.jd1, el.epoch_jd2 = epoch.jd2;
  return el;
}

struct LeapSecondState {
  Utc epoch, time;
  double position_km[3];
};

// Reference: tests/reference/sgp4_leap_seconds.py, python-sgp4 at the time elapsed by ERFA's TAI.
// The days of both are quasi Julian dates, as ERFA's.
constexpr LeapSecondState leap_second_states[] = {
    {{2457752.5, 0.25},
     {2457753.5, 0.4999942130299418},
     {-4908.6791594, 4149.0634438, -2232.8795145}},
    {{2457752.5, 0.25},
     {2457753.5, 0.9999942130299417},
     {1636.4349914, 4560.8310123, 4751.5182778}},
    {{2457752.5, 0.25}, {2457754.5, 0.5}, {4632.6654652, -4271.0974416, 2519.0699434}},
    {{2457753.5, 0.7499913195449127},
     {2457755.5, 0.0},
     {-4910.4828547, 4144.0022924, -2238.3267041}},
    {{2456108.5, 0.4999942130299418},
     {2456109.5, 0.5},
     {-4642.9464677, -244.3801186, -4969.7101331}},
    {{2454830.5, 0.5}, {2457754.5, 0.0}, {6695.6337488, -180.7400166, -1117.5998229}},
    {{2457756.5, 0.5},
     {2457753.5, 0.4999942130299418},
     {-5247.3636839, -484.9382996, -4305.9139336}},
    {{2441315.5, 0.5}, {2441318.5, 0.0}, {1999.9987422, -6326.7192014, -1460.6627190}},
};

double from_reference_km(const LeapSecondState& s, const double* metres, std::size_t stride) {
  double square = 0.0;
  for (std::size_t k = 0; k < 3; ++k)
    square += std::pow(metres[k * stride] / 1e3 - s.position_km[k], 2);
  return std::sqrt(square);
}

// A low orbit moves 7.6 km in a second: days of 86400 s are 3.8 km off at noon of the day with a
// leap second, and 7.6 km after it for every older epoch.
TEST(Sgp4LeapSeconds, ElapsedTimeIsThatOfTai) {
  for (const LeapSecondState& s : leap_second_states) {
    const Sgp4Batch batch(std::vector{low_orbit_of(s.epoch)});
    const Outputs all = at(batch, s.time.jd1, s.time.jd2);
    ASSERT_EQ(all.code[0], 0);
    EXPECT_LT(from_reference_km(s, all.position.data(), 1), 1e-5) << s.time.jd1;

    Outputs some(1);
    const std::uint32_t object = 0;
    batch.propagate_some({&object, 1}, s.time.jd1, s.time.jd2, some.position, some.velocity,
                         some.code);
    EXPECT_LT(from_reference_km(s, some.position.data(), 1), 1e-5) << s.time.jd1;

    const Sgp4State one =
        batch.propagate_one(0, batch.minutes_since_epoch(0, s.time.jd1, s.time.jd2));
    const double position_m[] = {one.position_m.x, one.position_m.y, one.position_m.z};
    EXPECT_LT(from_reference_km(s, position_m, 1), 1e-5) << s.time.jd1;
  }
}

// 23:59:58 to 00:00:01 by seconds, with 23:59:60 between: every step is one second of flight.
TEST(Sgp4LeapSeconds, EverySecondOfTheLeapIsASecondOfFlight) {
  const Sgp4Batch batch(std::vector{low_orbit_of({2457752.5, 0.25})});
  const double times[][2] = {{2457753.5, 86398.0 / 86401},
                             {2457753.5, 86399.0 / 86401},
                             {2457753.5, 86400.0 / 86401},
                             {2457754.5, 0.0},
                             {2457754.5, 1.0 / 86400}};
  double before_min = 0.0;
  for (const auto& t : times) {
    const double minutes = batch.minutes_since_epoch(0, t[0], t[1]);
    if (before_min > 0.0) {
      EXPECT_NEAR((minutes - before_min) * 60.0, 1.0, 1e-9) << t[1];
    }
    before_min = minutes;
  }
}

// Since 2017 the scale is UTC to the bit, however the date is split.
TEST(Sgp4LeapSeconds, DatesSince2017AreTheirOwn) {
  for (const Utc& utc : {Utc{2458138.5, 0.9861}, Utc{2458138.5, 3.25}, Utc{2457754.5, 0.0},
                         Utc{2461000.0, 0.1234567890123}}) {
    const ElapsedDate date = elapsed_date(utc);
    EXPECT_EQ(date.jd1, utc.jd1);
    EXPECT_EQ(date.jd2, utc.jd2);
  }
  EXPECT_NEAR(epoch_days_between({2457753.5, 0.0}, {2457754.5, 0.0}) * 86400.0, 86401.0, 1e-6);
  EXPECT_NEAR(epoch_days_between({2457753.0, 0.5}, {2457752.5, 2.0}) * 86400.0, 86401.0, 1e-6);
}

}  // namespace
}  // namespace dmise
