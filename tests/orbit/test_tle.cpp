#include "core/orbit/elements/tle.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace dmise {
namespace {

using testing::HasSubstr;

// The ISS on 2008-09-20; its first line has the checksum 7, its second the checksum 7.
const std::string iss1 = "1 25544U 98067A   08264.51782528 -.00002182  00000-0 -11606-4 0  2927";
const std::string iss2 = "2 25544  51.6416 247.4627 0006703 130.5360 325.0288 15.72125391563537";

std::string with_checksum(std::string line) {
  line.resize(68, ' ');
  return line + static_cast<char>('0' + tle_checksum(line));
}

/// `line` with `text` from column `column` (from 1) on, and its checksum put right.
std::string changed(const std::string& line, std::size_t column, const std::string& text) {
  return with_checksum(line.substr(0, column - 1) + text + line.substr(column - 1 + text.size()));
}

std::string why_refused(const std::string& line1, const std::string& line2, bool lenient = false) {
  try {
    parse_tle(line1, line2, lenient);
  } catch (const RecordError& error) {
    return error.what();
  }
  return "";
}

// Reference: python3-sgp4 2.x, tests/reference/tle_elements.py.
TEST(Tle, ElementsAreThoseOfTheReferenceReader) {
  const MeanElements e = parse_tle(iss1, iss2);
  EXPECT_EQ(e.catalogue_number, 25544u);
  EXPECT_EQ(e.designator, "98067A");
  EXPECT_EQ(e.classification, 'U');
  EXPECT_EQ(e.epoch_jd1, 2454729.5);
  EXPECT_EQ(e.epoch_jd2, 0.51782528);
  EXPECT_EQ(e.mean_motion_rad_per_min, 0.06859691081788306);
  EXPECT_EQ(e.eccentricity, 0.0006703);
  EXPECT_EQ(e.inclination_rad, 0.9013159509979036);
  EXPECT_EQ(e.raan_rad, 4.319038890874972);
  EXPECT_EQ(e.argument_of_perigee_rad, 2.278282992383318);
  EXPECT_EQ(e.mean_anomaly_rad, 5.672822723806145);
  EXPECT_DOUBLE_EQ(e.bstar_per_earth_radius, -1.1606e-05);
  EXPECT_DOUBLE_EQ(e.mean_motion_dot_rad_per_min2, -6.611646576131298e-11);
  EXPECT_EQ(e.mean_motion_ddot_rad_per_min3, 0.0);
  EXPECT_EQ(e.ephemeris_type, 0);
  EXPECT_EQ(e.element_number, 292);
  EXPECT_EQ(e.revolution, 56353);
}

// The last digit printed is 0.864 ms = 6 m along the orbit; one double would hold it to 40 us only.
TEST(Tle, EpochKeepsAllItsDigitsInTwoParts) {
  const MeanElements e = parse_tle(changed(iss1, 19, "20366.99999999"), iss2);
  EXPECT_EQ(e.epoch_jd1, 2459214.5);  // 2020-12-31
  EXPECT_EQ(e.epoch_jd2, 0.99999999);
}

TEST(Tle, EpochYears57And56AreACenturyApart) {
  EXPECT_EQ(parse_tle(changed(iss1, 19, "57277.00000000"), iss2).epoch_jd1, 2436115.5);  // 1957
  EXPECT_EQ(parse_tle(changed(iss1, 19, "56277.00000000"), iss2).epoch_jd1, 2472274.5);  // 2056
}

TEST(Tle, EpochDayMustExistInItsYear) {
  EXPECT_EQ(why_refused(changed(iss1, 19, "20366.00000000"), iss2), "");
  EXPECT_THAT(why_refused(changed(iss1, 19, "19366.00000000"), iss2), HasSubstr("out of range"));
  EXPECT_THAT(why_refused(changed(iss1, 19, "19000.50000000"), iss2), HasSubstr("out of range"));
}

// Reference: space-track.org's table of Alpha-5: I and O are left out.
TEST(Tle, Alpha5NumbersRunFrom100000To339999) {
  EXPECT_EQ(parse_alpha5("A0000"), 100000u);
  EXPECT_EQ(parse_alpha5("E8493"), 148493u);
  EXPECT_EQ(parse_alpha5("H9999"), 179999u);
  EXPECT_EQ(parse_alpha5("J2931"), 182931u);
  EXPECT_EQ(parse_alpha5("P4018"), 234018u);
  EXPECT_EQ(parse_alpha5("W1928"), 301928u);
  EXPECT_EQ(parse_alpha5("Z9999"), 339999u);
  EXPECT_EQ(parse_alpha5("    5"), 5u);
  for (const char* bad :
       {"I0000", "O0000", "a0000", "A000", "AB000", "12 45", "+1234", "     ", "A+000"})
    EXPECT_THROW(parse_alpha5(bad), RecordError) << bad;
  const MeanElements e = parse_tle(changed(iss1, 3, "T0042"), changed(iss2, 3, "T0042"));
  EXPECT_EQ(e.catalogue_number, 270042u);
}

TEST(Tle, BlanksStandForZeros) {
  const std::string line1 =
      with_checksum("1     5U           1  1.50000000  .           0           ");
  const std::string line2 =
      with_checksum("2     5   0.0000   0.0000       3   0.0000   0.0000  1.00270000    7");
  const MeanElements e = parse_tle(changed(line1, 34, " .00000001"), line2);
  EXPECT_EQ(e.catalogue_number, 5u);
  EXPECT_EQ(e.designator, "");
  EXPECT_EQ(e.epoch_jd1, 2451910.5);  // 2001-01-01
  EXPECT_EQ(e.epoch_jd2, 0.5);
  EXPECT_EQ(e.eccentricity, 3e-7);
  EXPECT_EQ(e.bstar_per_earth_radius, 0.0);
  EXPECT_EQ(e.ephemeris_type, 0);
  EXPECT_EQ(e.element_number, 0);
  EXPECT_EQ(e.revolution, 7);
}

TEST(Tle, WrongChecksumIsRefusedAndReadWhenAskedFor) {
  std::string wrong = iss2;
  wrong.back() = '4';
  EXPECT_EQ(why_refused(iss1, wrong), "line 2 has a wrong checksum, expected 7, got \"4\"");
  std::string warning;
  EXPECT_EQ(parse_tle(iss1, wrong, true, &warning), parse_tle(iss1, iss2));
  EXPECT_THAT(warning, HasSubstr("wrong checksum"));
}

TEST(Tle, LineOf67ColumnsIsRefusedAndReadWhenAskedFor) {
  EXPECT_THAT(why_refused(iss1.substr(0, 67), iss2), HasSubstr("line 1 has 67 columns, not 69"));
  EXPECT_THAT(why_refused(iss1, iss2.substr(0, 67)), HasSubstr("line 2 has 67 columns, not 69"));
  EXPECT_EQ(parse_tle(iss1.substr(0, 67), iss2.substr(0, 67), true).revolution, 5635);
}

// 67 columns because two characters went missing on the way: nothing stands where it should.
TEST(Tle, LineWithLostCharactersIsRefusedEvenWhenLenient) {
  std::string lost = iss1;
  lost.erase(20, 2);
  EXPECT_THAT(why_refused(lost, iss2, true), HasSubstr("column"));
  EXPECT_THAT(why_refused(iss1.substr(0, 60), iss2, true), HasSubstr("60 columns"));
}

TEST(Tle, MissingChecksumIsRefusedAndReadWhenAskedFor) {
  EXPECT_THAT(why_refused(iss1.substr(0, 68), iss2), HasSubstr("no checksum"));
  EXPECT_EQ(parse_tle(iss1.substr(0, 68), iss2.substr(0, 68), true), parse_tle(iss1, iss2));
}

// Type 4 is SGP4-XP: its elements mean something else and SGP4 is kilometres off with them.
TEST(Tle, EphemerisType4IsRefused) {
  EXPECT_THAT(why_refused(changed(iss1, 63, "4"), iss2),
              HasSubstr("ephemeris type is not SGP4's, got \"4\""));
  EXPECT_THAT(why_refused(changed(iss1, 63, "4"), iss2, true), HasSubstr("ephemeris type"));
}

TEST(Tle, TextAfterColumn69IsIgnored) {
  EXPECT_EQ(parse_tle(iss1, iss2 + "     0.0  1440.0  360.0"), parse_tle(iss1, iss2));
  EXPECT_THAT(why_refused(iss1, iss2 + "5"), HasSubstr("70 columns"));
}

TEST(Tle, NonsenseInAnyFieldNamesTheFieldAndTheValue) {
  const struct {
    int line;
    std::size_t column;
    std::string text, reason;
  } cases[] = {{1, 3, "255x4", "catalogue number"},
               {1, 19, "0x264", "epoch"},
               {1, 35, ".0x", "mean motion dot"},
               {1, 54, "-11x06-4", "drag term"},
               {1, 45, " 00000*0", "mean motion ddot"},
               {2, 9, "181.0000", "inclination"},
               {2, 18, "360.0001", "right ascension"},
               {2, 27, "00x6703", "eccentricity"},
               {2, 35, "-30.5360", "argument of perigee"},
               {2, 44, " nan.000", "column 47"},
               {2, 53, " 0.00000000", "mean motion out of range"},
               {2, 3, "25545", "another object"},
               {1, 53, "x", "column 53"},
               {1, 33, "\xa0", "printable ASCII"}};
  for (const auto& c : cases)
    EXPECT_THAT(why_refused(c.line == 1 ? changed(iss1, c.column, c.text) : iss1,
                            c.line == 2 ? changed(iss2, c.column, c.text) : iss2),
                HasSubstr(c.reason))
        << c.column;
}

}  // namespace
}  // namespace dmise
