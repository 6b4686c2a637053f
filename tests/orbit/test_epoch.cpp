#include "core/orbit/elements/epoch.h"

#include <gtest/gtest.h>

namespace dmise {
namespace {

// Julian dates: Astronomical Almanac; day of year 264 of 2008 is 20 September.
TEST(Epoch, CalendarAndOrdinalDatesAgree) {
  EXPECT_EQ(*parse_iso_epoch("2008-09-20T12:00:00"), (Utc{2454729.5, 0.5}));
  EXPECT_EQ(*parse_iso_epoch("2008-264T12:00:00.000Z"), (Utc{2454729.5, 0.5}));
  EXPECT_EQ(*parse_iso_epoch("2000-01-01T12:00:00"), (Utc{2451544.5, 0.5}));
  EXPECT_EQ(*parse_iso_epoch("1957-10-04T00:00:00"), (Utc{2436115.5, 0.0}));
  EXPECT_EQ(*parse_iso_epoch(" 2024-02-29 06:00:00 "), (Utc{2460369.5, 0.25}));
}

TEST(Epoch, MicrosecondsAreKept) {
  const double us = 1e-6 / 86400;
  const double a = parse_iso_epoch("2026-08-18T22:42:27.673632")->jd2;
  const double b = parse_iso_epoch("2026-08-18T22:42:27.673633")->jd2;
  EXPECT_NEAR(b - a, us, 3e-16);
}

TEST(Epoch, SecondSixtyExistsOnlyAtTheEndOfADayWithALeapSecond) {
  EXPECT_NEAR(parse_iso_epoch("2016-12-31T23:59:60.5")->jd2, 86400.5 / 86401, 1e-15);
  EXPECT_FALSE(parse_iso_epoch("2016-12-30T23:59:60"));
  EXPECT_FALSE(parse_iso_epoch("2016-12-31T22:59:60"));
  EXPECT_EQ(format_iso_epoch(*parse_iso_epoch("2016-12-31T23:59:60.5")), "2016-12-31T23:59:60.500");
}

TEST(Epoch, WhatIsNoTimeIsNothing) {
  for (const char* text :
       {"", "T", "2026", "2026-01-01", "2026-13-01T00:00:00", "2026-02-29T00:00:00",
        "2026-000T00:00:00", "2026-366T00:00:00", "2026-01-01T24:00:00", "2026-01-01T00:60:00",
        "2026-01-01T00:00:61", "2026-01-01T00:00", "2026-01-01T00:00:00+01", "2026-1-01T00:00:00",
        "2026-01-01T00:00:1e1", "2026-01-01T00:00:00.1.2", "0026-01-01T00:00:00"})
    EXPECT_FALSE(parse_iso_epoch(text)) << text;
}

TEST(Epoch, WrittenTimeIsTheNearest) {
  EXPECT_EQ(format_iso_epoch({2454729.5, 0.51782528}, 6), "2008-09-20T12:25:40.104192");
  EXPECT_EQ(format_iso_epoch({2454729.5, 0.9999999999}, 0), "2008-09-21T00:00:00");
}

}  // namespace
}  // namespace dmise
