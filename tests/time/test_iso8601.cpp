#include "core/time/iso8601.h"

#include <gtest/gtest.h>

#include "core/base/error.h"

namespace dmise {
namespace {

// Reference: ERFA 2.0, eraDtf2d("UTC", 2018, 1, 20, 23, 40, 0): 2458138.5 + 0.9861111111111111605.
TEST(Iso8601, ReadsATimeAsErfaDoes) {
  const Utc utc = parse_utc("2018-01-20T23:40:00Z");
  EXPECT_EQ(utc.jd1, 2458138.5);
  EXPECT_DOUBLE_EQ(utc.jd2, 0.9861111111111111605);
}

TEST(Iso8601, NanosecondsSurviveTheRoundTrip) {
  for (const char* text : {"2018-01-20T23:40:00.000000001Z", "2026-11-21T23:59:59.999999999Z",
                           "1972-01-01T00:00:00.123456789Z", "2016-12-31T23:59:60.999999999Z"})
    EXPECT_EQ(format_utc(parse_utc(text), 9), text);
}

TEST(Iso8601, FewerDecimalsRoundDown) {
  const Utc utc = parse_utc("2026-11-21T23:59:59.999999999");
  EXPECT_EQ(format_utc(utc), "2026-11-21T23:59:59.999Z");
  EXPECT_EQ(format_utc(utc, 0), "2026-11-21T23:59:59Z");
}

TEST(Iso8601, TheSixtiethSecondIsATimeOnlyWhereThereIsOne) {
  EXPECT_EQ(format_utc(parse_utc("2016-12-31T23:59:60.5Z"), 1), "2016-12-31T23:59:60.5Z");
  EXPECT_THROW(parse_utc("2017-12-31T23:59:60Z"), ConfigError);
  EXPECT_THROW(parse_utc("2016-12-31T12:00:60Z"), ConfigError);
}

TEST(Iso8601, ADateAloneIsItsMidnight) {
  EXPECT_EQ(parse_utc("2018-01-20"), parse_utc("2018-01-20 00:00:00"));
}

TEST(Iso8601, WhatIsNoTimeIsRefusedWithItsText) {
  for (const char* text : {"", "2018", "2018-02-30", "2018-01-20T24:00:00Z", "2018-01-20T23:40",
                           "2018-01-20T23:40:00+01:00", "2018-01-20T23:40:00.", "20180120T234000Z",
                           "2018-01-20T23:40:00.1234567891Z", "1971-01-01", "-018-01-20"}) {
    try {
      parse_utc(text);
      ADD_FAILURE() << "accepted " << text;
    } catch (const ConfigError& error) {
      EXPECT_NE(std::string(error.what()).find(std::string("got \"") + text), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace dmise
