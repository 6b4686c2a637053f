#include "core/ingest/standard_cards.h"

#include <gtest/gtest.h>

#include "core/ingest/exposure_times.h"
#include "core/ingest/site_cards.h"
#include "core/time/iso8601.h"

namespace dmise {
namespace {

std::string start_of(const FitsValues& values) {
  FrameNotes notes;
  const auto times = exposure_times(StandardCards(values, notes));
  return times.start ? format_utc(*times.start, 3) : "none";
}

TEST(StandardCards, ReadsAnglesInAllForms) {
  FrameNotes notes;
  const FitsValues values = {{"A", "12 30 36.0"}, {"B", "-00:30:00"}, {"C", "12.5"},
                             {"D", "12 61 0"},    {"E", "north"},     {"F", "1D1"},
                             {"G", " -33 46 12"}};
  const StandardCards cards(values, notes);
  EXPECT_DOUBLE_EQ(*cards.angle_deg("A", true), 187.65);
  EXPECT_DOUBLE_EQ(*cards.angle_deg("B", false), -0.5);
  EXPECT_DOUBLE_EQ(*cards.angle_deg("C", false), 12.5);
  EXPECT_DOUBLE_EQ(*cards.angle_deg("F", false), 10.0);
  EXPECT_DOUBLE_EQ(*cards.angle_deg("G", false), -33.77);
  EXPECT_FALSE(cards.angle_deg("D", false));
  EXPECT_FALSE(cards.angle_deg("E", false));
  EXPECT_EQ(notes.missing, (std::vector<std::string>{"D: is not an angle, got 12 61 0",
                                                     "E: is not a finite number, got north"}));
}

// Reference: astropy 5.2, Time(text, scale=...).utc.isot; tests/reference/foreign_frames.py.
TEST(ExposureTimes, ReadsDatesInAllScales) {
  const std::string text = "2024-03-01T00:00:10.5";
  EXPECT_EQ(start_of({{"DATE-OBS", text}}), "2024-03-01T00:00:10.500Z");
  EXPECT_EQ(start_of({{"DATE-OBS", text}, {"TIMESYS", "TAI"}}), "2024-02-29T23:59:33.500Z");
  EXPECT_EQ(start_of({{"DATE-OBS", text}, {"TIMESYS", "TT"}}), "2024-02-29T23:59:01.316Z");
  EXPECT_EQ(start_of({{"DATE-OBS", text}, {"TIMESYS", "GPS"}}), "2024-02-29T23:59:52.500Z");
  EXPECT_EQ(start_of({{"DATE-OBS", "2024-03-01"}, {"UT", "12:34:56.7"}}),
            "2024-03-01T12:34:56.700Z");
  EXPECT_EQ(start_of({{"MJD-OBS", "60370.5"}}), "2024-03-01T12:00:00.000Z");
  // A day with a leap second in UTC, which has 86400 s in TAI.
  EXPECT_EQ(start_of({{"MJD-OBS", "57753.5"}, {"TIMESYS", "TAI"}}), "2016-12-31T11:59:24.000Z");
  EXPECT_EQ(start_of({{"DATE-AVG", text}, {"EXPTIME", "20"}}), "2024-03-01T00:00:00.500Z");
  EXPECT_EQ(start_of({{"DATE-END", text}, {"EXPTIME", "10"}}), "2024-03-01T00:00:00.500Z");
  EXPECT_EQ(start_of({{"DATE-OBS", "2024-03-01T00:00:10.123456789012"}}),
            "2024-03-01T00:00:10.123Z");
}

TEST(ExposureTimes, SaysWhatIsMissing) {
  FrameNotes notes;
  const FitsValues values = {{"DATE-OBS", "yesterday 10:00"}, {"EXPTIME", "-1"}};
  const auto times = exposure_times(StandardCards(values, notes));
  EXPECT_FALSE(times.start || times.exposure_s);
  EXPECT_EQ(notes.missing[0], "EXPTIME: exposure time: must be in (0, 1e6) s, got -1");
  EXPECT_EQ(notes.missing[1],
            "DATE-OBS: time: is not a date and time of 1972 to 2099, got yesterday 10:00");
}

TEST(ExposureTimes, TellsPlanesByTheThirdAxis) {
  FrameNotes notes;
  const FitsValues axis = {{"CTYPE3", "TIME"}, {"CDELT3", "0.5"}, {"CUNIT3", "min"}};
  EXPECT_EQ(seconds_to_plane(StandardCards(axis, notes), 4), 120.0);
  const FitsValues cycle = {{"KCT", "0.04"}};
  EXPECT_EQ(seconds_to_plane(StandardCards(cycle, notes), 100), 4.0);
  EXPECT_FALSE(seconds_to_plane(StandardCards({}, notes), 1));
}

// Reference: the site of Atlanta in launch/sites by its ITRS position, to a metre.
TEST(SiteCards, ReadsAnglesAndPositions) {
  FrameNotes notes;
  const FitsValues angles = {{"SITELAT", "51 28 38"}, {"SITELONG", "-0:00:05"}, {"SITEELEV", "47"}};
  const auto site = site_of(StandardCards(angles, notes));
  ASSERT_TRUE(site);
  EXPECT_NEAR(site->latitude_deg, 51.4772222, 1e-6);
  EXPECT_NEAR(site->longitude_deg, -0.0013889, 1e-6);
  EXPECT_EQ(site->height_m, 47);
  const Vec<Itrs> p = itrs_from_geodetic(*site);
  const FitsValues position = {{"OBSGEO-X", std::to_string(p.x)},
                               {"OBSGEO-Y", std::to_string(p.y)},
                               {"OBSGEO-Z", std::to_string(p.z)}};
  const auto back = site_of(StandardCards(position, notes));
  ASSERT_TRUE(back);
  EXPECT_NEAR(back->latitude_deg, site->latitude_deg, 1e-9);
  EXPECT_NEAR(back->height_m, 47, 1e-3);
  const FitsValues wrong = {{"SITELAT", "95"}, {"SITELONG", "0"}};
  EXPECT_FALSE(site_of(StandardCards(wrong, notes)));
  EXPECT_EQ(notes.missing[0], "SITELAT: site: must be in -90..90 deg, got 95");
}

}  // namespace
}  // namespace dmise
