#include "core/time/leap_seconds.h"

#include <gtest/gtest.h>

#include "core/base/error.h"

namespace dmise {
namespace {

// Reference: IERS Bulletin C and its history of TAI - UTC.
TEST(LeapSeconds, AgreeWithTheHistoryOfTheIers) {
  EXPECT_EQ(tai_minus_utc_s(41317), 10);  // 1972-01-01
  EXPECT_EQ(tai_minus_utc_s(41498), 10);  // 1972-06-30
  EXPECT_EQ(tai_minus_utc_s(41499), 11);
  EXPECT_EQ(tai_minus_utc_s(51178), 31);  // 1998-12-31
  EXPECT_EQ(tai_minus_utc_s(51179), 32);
  EXPECT_EQ(tai_minus_utc_s(57753), 36);  // 2016-12-31
  EXPECT_EQ(tai_minus_utc_s(57754), 37);
  EXPECT_EQ(utc_day_length_s(57753), 86401);
  EXPECT_EQ(utc_day_length_s(57754), 86400);
}

TEST(LeapSeconds, BeforeWholeSecondsWereKeptIsAnError) {
  EXPECT_THROW(tai_minus_utc_s(41315), Error);
}

// Rates at the first instant are taken from instants on both sides of it.
TEST(LeapSeconds, TheDayBeforeHasThoseOfTheFirst) {
  EXPECT_EQ(tai_minus_utc_s(41316), 10);
  EXPECT_EQ(utc_day_length_s(41316), 86400);
  const TaiInstant first = to_tai({41317, 0});
  EXPECT_EQ(to_utc({first.mjd, first.ns_of_day - 1'000'000'000}),
            (UtcInstant{41316, 86'399'000'000'000}));
}

// Reference: ERFA 2.0 eraDat returns 1 for years that lie more than 5 years after its release.
TEST(LeapSeconds, YearsFarBeyondTheTableAreUncertain) {
  EXPECT_FALSE(leap_seconds_uncertain(58138));  // 2018
  EXPECT_TRUE(leap_seconds_uncertain(66154));   // 2040
}

TEST(LeapSeconds, UtcReturnsThroughTaiForEveryQuarterSecondAroundALeapSecond) {
  TaiInstant before{};
  for (int quarter = -20; quarter <= 20; ++quarter) {
    const std::int64_t ns = 86400 * ns_per_s + quarter * (ns_per_s / 4);
    const UtcInstant utc =
        ns < 86401 * ns_per_s ? UtcInstant{57753, ns} : UtcInstant{57754, ns - 86401 * ns_per_s};
    const TaiInstant tai = to_tai(utc);
    EXPECT_EQ(to_utc(tai), utc);
    EXPECT_EQ(to_instant(to_julian_date(utc)), utc);
    if (quarter > -20) {
      EXPECT_EQ((tai.mjd - before.mjd) * ns_per_day + tai.ns_of_day - before.ns_of_day,
                ns_per_s / 4);
    }
    before = tai;
  }
}

}  // namespace
}  // namespace dmise
