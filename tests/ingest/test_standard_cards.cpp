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

// Reference: FITS Standard 4.0, sections 4.4.2.1 and 9; astropy 5.2 for TAI and the day before.
TEST(ExposureTimes, ReadsDatesAsCamerasWriteThem) {
  EXPECT_EQ(start_of({{"DATE-OBS", "2018-01-20T18:02:00.317-0700"}}), "2018-01-21T01:02:00.317Z");
  EXPECT_EQ(start_of({{"DATE-OBS", "2018-01-21T03:32:00.5+02:30"}}), "2018-01-21T01:02:00.500Z");
  EXPECT_EQ(start_of({{"DATE-OBS", "2018-01-21T03:02:00+02"}}), "2018-01-21T01:02:00.000Z");
  EXPECT_EQ(start_of({{"DATE-OBS", "2018-01-21 01:02:00.5 UTC"}}), "2018-01-21T01:02:00.500Z");
  EXPECT_EQ(start_of({{"DATE-OBS", "21/01/98"}, {"TIME-OBS", "01:02:00"}}),
            "1998-01-21T01:02:00.000Z");
  EXPECT_EQ(start_of({{"DATE-OBS", "2018/01/21"}, {"UT", "1:02:00.25"}}),
            "2018-01-21T01:02:00.250Z");
  EXPECT_EQ(start_of({{"DATE-OBS", "01/21/2018 01:02:00"}}), "2018-01-21T01:02:00.000Z");
  EXPECT_EQ(start_of({{"DATE_OBS", "2021-04-07T12:03:57.256"}}), "2021-04-07T12:03:57.256Z");
  // As SDSS writes them.
  EXPECT_EQ(start_of({{"DATE-OBS", "2009-10-17"}, {"TAIHMS", "01:53:10.59"}, {"TIMESYS", "TAI"}}),
            "2009-10-17T01:52:36.590Z");
  // The end of another shutter motion does not replace a start.
  EXPECT_EQ(start_of({{"DATE-OBS", "2020-05-28"},
                      {"UT", "14:32:17.953"},
                      {"MJD-END", "58997.60624778"},
                      {"EXPTIME", "40"}}),
            "2020-05-28T14:32:17.953Z");
  EXPECT_EQ(start_of({{"DATE-OBS", "2018-01-21T01:02:00+99:00:00"}}), "none");
  EXPECT_EQ(start_of({{"DATE-OBS", "31/31/98"}, {"TIME-OBS", "01:02:00"}}), "none");
  EXPECT_EQ(start_of({{"DATE-OBS", "2018-01-21T"}}), "none");
}

TEST(ExposureTimes, KnowsHowWellADateIsTold) {
  FrameNotes notes;
  const auto width_of = [&](const FitsValues& values) {
    return exposure_times(StandardCards(values, notes)).width_s;
  };
  EXPECT_NEAR(width_of({{"MJD-OBS", "58139.043"}}), 86.4, 1e-9);
  EXPECT_EQ(notes.assumed[0], "time: the last digit of MJD-OBS is 86.4 s: no time is known better");
  EXPECT_NEAR(width_of({{"MJD-OBS", "5.8139043E4"}}), 86.4, 1e-9);
  EXPECT_NEAR(width_of({{"MJD-OBS", "58997.60576334"}}), 0.000864, 1e-12);
  EXPECT_EQ(width_of({{"DATE-OBS", "2018-01-21T01:02"}}), 60.0);
  EXPECT_EQ(width_of({{"DATE-OBS", "2018-01-21T01:02:00"}}), 0.0);
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

TEST(StandardCards, ReadsAnglesWithUnitsAndSides) {
  FrameNotes notes;
  const FitsValues values = {{"A", "12h30m36s"},       {"B", "33d46m37.2s N"},
                             {"C", "84.398 W"},        {"D", "+33:46:37:20"},
                             {"E", "-84:23:52:80"},    {"F", "33:46:37.5:20"},
                             {"G", "84 23 52.8 West"}, {"H", "33?46'37\""}};
  const StandardCards cards(values, notes);
  EXPECT_DOUBLE_EQ(*cards.angle_deg("A", true), 187.65);
  EXPECT_DOUBLE_EQ(*cards.angle_deg("B", false), 33 + 46 / 60.0 + 37.2 / 3600);
  EXPECT_DOUBLE_EQ(*cards.angle_deg("C", false), -84.398);
  EXPECT_DOUBLE_EQ(*cards.angle_deg("D", false), 33 + 46 / 60.0 + 37.2 / 3600);
  EXPECT_DOUBLE_EQ(*cards.angle_deg("E", false), -(84 + 23 / 60.0 + 52.8 / 3600));
  EXPECT_DOUBLE_EQ(*cards.angle_deg("H", false), 33 + 46 / 60.0 + 37 / 3600.0);
  EXPECT_EQ(notes.assumed[0], "D: its fourth part is taken for hundredths of a second");
  EXPECT_FALSE(cards.angle_deg("F", false));
  EXPECT_FALSE(cards.angle_deg("G", false));
}

// Names that SharpCap, NINA and observatories use.
TEST(SiteCards, ReadsTheNamesOfManyPrograms) {
  for (const auto& [latitude, longitude] : {std::pair{"OBSLAT", "OBSLONG"},
                                            {"SITELAT", "SITELON"},
                                            {"LATITUDE", "LONGITUD"},
                                            {"GEOLAT", "GEOLON"},
                                            {"OBSLAT", "OBSLON"}}) {
    FrameNotes notes;
    const FitsValues values = {{latitude, "+33:46:37"}, {longitude, "-84:23:53"}};
    const auto site = site_of(StandardCards(values, notes));
    ASSERT_TRUE(site) << latitude;
    EXPECT_NEAR(site->latitude_deg, 33.776944, 1e-6);
    EXPECT_NEAR(site->longitude_deg, -84.398056, 1e-6);
  }
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
