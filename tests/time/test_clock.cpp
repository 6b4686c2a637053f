#include "core/time/clock.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/time/iso8601.h"
#include "tests/support/data.h"

namespace dmise {
namespace {

constexpr double ns = 1e-9;
constexpr double ten_years_s = 10 * 365.25 * 86400;

// Reference: TAI - UTC = 37 s from 2017 (IERS Bulletin C 52), TT - TAI = 32.184 s (IAU 1991).
TEST(Clock, ScalesAgreeWithTheirDefinitions) {
  const Clock clock(parse_utc("2018-01-20T23:40:00Z"));
  const SimTime t = sim_seconds(1234.567890123);
  EXPECT_EQ(clock.tai(t).jd1, 2458139.5);
  EXPECT_NEAR(clock.tai(t).jd2 * 86400, (1234.567890123 + 37) - 1200.0, 0.1 * ns);
  EXPECT_NEAR(clock.tt(t).jd2 * 86400, (1234.567890123 + 37 + 32.184) - 1200.0, 0.1 * ns);
  EXPECT_EQ(format_utc(clock.utc(t), 9), "2018-01-21T00:00:34.567890123Z");
}

TEST(Clock, TimesThatNanosecondsCannotCountAreRefused) {
  const Clock clock(parse_utc("2018-01-20T00:00:00Z"));
  EXPECT_NO_THROW(clock.sim_time(parse_utc("2310-05-01T00:00:00Z")));
  EXPECT_THROW(clock.sim_time(parse_utc("2310-05-03T00:00:00Z")), Error);
  EXPECT_THROW(clock.sim_time(parse_utc("9999-12-31T00:00:00Z")), Error);
}

TEST(Clock, ARunAcrossALeapSecondIsUniformInTai) {
  const Clock clock(parse_utc("2016-12-31T23:59:58Z"));
  const char* seconds[] = {"2016-12-31T23:59:58Z", "2016-12-31T23:59:59Z", "2016-12-31T23:59:60Z",
                           "2017-01-01T00:00:00Z", "2017-01-01T00:00:01Z"};
  for (int s = 0; s < 5; ++s) {
    EXPECT_EQ(format_utc(clock.utc(sim_seconds(s)), 0), seconds[s]);
    EXPECT_EQ(clock.sim_time(parse_utc(seconds[s])), sim_seconds(s));
    EXPECT_NEAR(days_between(clock.tt(sim_seconds(s)), clock.tt({})) * 86400, s, 0.1 * ns);
  }
}

TEST(Clock, TenYearsOfMicrosecondAndHourTicksDoNotDrift) {
  const Clock clock(parse_utc("2018-01-20T23:40:00Z"));
  constexpr std::int64_t microsecond = 1'000, hour = 3'600'000'000'000;
  for (const std::int64_t tick_ns : {microsecond, hour}) {
    const Tick last = static_cast<Tick>(ten_years_s * 1e9) / tick_ns;
    for (Tick k : {Tick{1}, last / 3, last - 1, last}) {
      const SimTime t{k * tick_ns};
      EXPECT_EQ(clock.sim_time(clock.utc(t)), t);
      EXPECT_EQ(clock.utc(clock.sim_time(clock.utc(t))), clock.utc(t));
    }
  }
  // No leap second has been announced since the table's last, so ten years on the clock reads this.
  EXPECT_EQ(format_utc(clock.utc(sim_seconds(ten_years_s)), 9), "2028-01-21T11:40:00.000000000Z");
}

TEST(Clock, TheWholeRangeOfSimulationTimeIsUsable) {
  const Clock clock(parse_utc("2018-01-20T23:59:59.999999999Z"));
  const SimTime end{INT64_MAX};
  EXPECT_EQ(clock.sim_time(clock.utc(end)), end);
  EXPECT_THROW(clock.utc(SimTime{INT64_MIN}), Error);  // 1725
}

TEST(Clock, TheEarthDoesNotJumpAtALeapSecondWithoutAnIersFile) {
  const Clock clock(parse_utc("2016-12-31T23:59:58Z"));
  for (int s = 0; s < 6; ++s)
    EXPECT_NEAR(days_between(clock.ut1(sim_seconds(s)), clock.ut1({})) * 86400, s, 0.1 * ns);
}

TEST(Clock, KeepsTheLastMeasuredEarthRotationWithinARun) {
  const std::string path = test::data_path("eop/finals2000A.all.gz");
  DMISE_NEEDS_FILE(path);
  const auto iers = std::make_shared<const IersTable>(IersTable::read_finals2000a(path));
  const UtcInstant end{iers->last_mjd(), 0};
  const Clock clock(to_julian_date({end.mjd - 1, 0}), iers);
  const SimTime last = clock.sim_time(to_julian_date(end));
  const double before = clock.earth_rotation(last).ut1_minus_tai_s;
  EXPECT_EQ(clock.earth_rotation(last + sim_seconds(1)).ut1_minus_tai_s, before);
  EXPECT_TRUE(clock.warnings(last).empty());
  EXPECT_EQ(clock.warnings(last + sim_seconds(1)).size(), 1u);
}

TEST(Clock, WithoutAnIersFileUt1IsUtcAndSaysSo) {
  const Clock clock(parse_utc("2018-01-20T23:40:00Z"));
  EXPECT_DOUBLE_EQ(clock.ut1({}).jd2, clock.utc({}).jd2);
  EXPECT_EQ(clock.earth_rotation({}).polar_motion_x_rad, 0.0);
  const std::vector<std::string> lines = clock.warnings(sim_seconds(60));
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_NE(lines[0].find("0.9 s or 13.5 arcsec"), std::string::npos);
}

TEST(Clock, LeapSecondsNobodyKnowsYetAreAWarningNotAnError) {
  const Clock clock(parse_utc("2018-01-20T23:40:00Z"));
  const std::vector<std::string> lines = clock.warnings(sim_seconds(20 * 365.25 * 86400));
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_NE(lines[0].find("leap seconds"), std::string::npos);
}

// Reference: astropy with the same file, tests/reference/earth_rotation.py.
TEST(Clock, Ut1AgreesWithAstropyAcrossALeapSecond) {
  const std::string path = test::data_path("eop/finals2000A.all.gz");
  DMISE_NEEDS_FILE(path);
  const auto iers = std::make_shared<const IersTable>(IersTable::read_finals2000a(path));
  const Clock clock(parse_utc("2016-12-31T18:00:00Z"), iers);
  const SimTime later = clock.sim_time(parse_utc("2017-01-01T06:00:00Z"));
  EXPECT_NEAR(clock.ut1({}).jd2 * 86400, 18 * 3600 + -0.408466867, 1e-6);
  EXPECT_NEAR(clock.ut1(later).jd2 * 86400, 6 * 3600 + 0.591026850, 1e-6);
  EXPECT_TRUE(clock.warnings(later).empty());
}

TEST(Clock, BeyondTheIersFileIsAWarningThatNamesItsSpan) {
  const std::string path = test::data_path("eop/finals2000A.all.gz");
  DMISE_NEEDS_FILE(path);
  const auto iers = std::make_shared<const IersTable>(IersTable::read_finals2000a(path));
  const Clock clock(parse_utc("2026-01-01T00:00:00Z"), iers);
  const std::vector<std::string> lines = clock.warnings(sim_seconds(60));
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_NE(lines[0].find("1973-01-02T00:00:00Z to 2021"), std::string::npos) << lines[0];
  EXPECT_EQ(clock.ut1({}).jd2, clock.utc({}).jd2);
}

}  // namespace
}  // namespace dmise
