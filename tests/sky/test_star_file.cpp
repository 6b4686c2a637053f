#include "core/sky/stars/star_file.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/files/digest.h"
#include "core/base/files/text_file.h"
#include "core/base/units.h"
#include "tests/support/data.h"

namespace dmise {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

StarReading read(const std::string& path) { return parse_stars(read_text_file(path), path); }

std::size_t nearest(const StarCatalogue& c, double ra_rad, double dec_rad) {
  std::size_t best = 0;
  double least = 1e9;
  for (std::size_t i = 0; i < c.size(); ++i) {
    const double apart =
        std::hypot((c.ra_rad[i] - ra_rad) * std::cos(dec_rad), c.dec_rad[i] - dec_rad);
    if (apart < least) best = i, least = apart;
  }
  return best;
}

double hms(double h, double m, double s) { return (h + m / 60 + s / 3600) * 15 * deg; }
double dms(double d, double m, double s) { return (d + m / 60 + s / 3600) * deg; }

// SIMBAD: 61 Cyg A 21 06 53.9396 +38 44 57.902 (ICRS, epoch J2000); Hipparcos (CDS I/239): proper
// motion 4155.10 (in RA times cos Dec), 3258.90 mas/yr, parallax 287.13 mas. At the epoch of
// Hipparcos, J1991.25, the star stood 46 arcsec away.
TEST(StarFile, KstarsPlacesAreOfJ2000AndMotionsAreOnTheSky) {
  const std::string path = test::catalogue_path("stars.dat.gz");
  EXPECT_EQ(sha256_hex(read_text_file(path)),
            "79c9c6b5316623ccc4c9d8add5609fdd8dffac078ee67dbdf4b7e5c4030ce544");
  const StarReading stars = read(path);
  EXPECT_EQ(stars.catalogue.size(), 125982u);
  EXPECT_TRUE(stars.problems.empty());
  const StarCatalogue& c = stars.catalogue;
  std::size_t i = nearest(c, hms(21, 6, 53.9396), dms(38, 44, 57.902));
  EXPECT_NEAR(c.ra_rad[i], hms(21, 6, 53.9396), 0.2 * arcsec);
  EXPECT_NEAR(c.dec_rad[i], dms(38, 44, 57.902), 0.1 * arcsec);
  EXPECT_NEAR(c.pm_ra_cosdec_rad_per_yr[i], 4155.1 * mas, 0.1 * mas);
  EXPECT_NEAR(c.pm_dec_rad_per_yr[i], 3258.9 * mas, 0.1 * mas);
  EXPECT_NEAR(c.parallax_rad[i], 287.1 * mas, 0.1 * mas);
  EXPECT_NEAR(c.v_mag[i], 5.20, 0.01);
  EXPECT_NEAR(c.bv[i], 1.07, 0.01);
  // Groombridge 1830: SIMBAD 11 52 58.7684 +37 43 07.240; Hipparcos 4003.69, -5813.00 mas/yr.
  i = nearest(c, hms(11, 52, 58.7684), dms(37, 43, 7.24));
  EXPECT_NEAR(c.ra_rad[i], hms(11, 52, 58.7684), 0.2 * arcsec);
  EXPECT_NEAR(c.pm_ra_cosdec_rad_per_yr[i], 4003.69 * mas, 0.1 * mas);
  EXPECT_NEAR(c.pm_dec_rad_per_yr[i], -5813.00 * mas, 0.1 * mas);
  // Polaris: Hipparcos 44.22 mas/yr in RA on the sky; divided by cos Dec it would be 3477.
  i = nearest(c, hms(2, 31, 49.095), dms(89, 15, 50.79));
  EXPECT_NEAR(c.pm_ra_cosdec_rad_per_yr[i], 44.22 * mas, 0.1 * mas);
}

// Reference: the file's own description (CDS V/50) and Sirius in Hipparcos: -546.01, -1223.08
// mas/yr.
TEST(StarFile, YaleBrightStarCatalogue) {
  const std::string path = test::data_path("stars/bsc5.dat.gz");
  DMISE_NEEDS_FILE(path);
  const StarReading stars = read(path);
  EXPECT_THAT(stars.problems, testing::SizeIs(0));
  EXPECT_GT(stars.catalogue.size(), 9080u);
  const StarCatalogue& c = stars.catalogue;
  const auto at = std::size_t(std::find(c.id.begin(), c.id.end(), 2491u) - c.id.begin());
  ASSERT_LT(at, c.size());
  EXPECT_NEAR(c.v_mag[at], -1.46, 0.01);
  EXPECT_NEAR(c.ra_rad[at], hms(6, 45, 8.9), 1 * arcsec);
  EXPECT_NEAR(c.dec_rad[at], -dms(16, 42, 58), 1 * arcsec);
  EXPECT_NEAR(c.pm_ra_cosdec_rad_per_yr[at], -546.01 * mas, 10 * mas);
  EXPECT_NEAR(c.pm_dec_rad_per_yr[at], -1223.08 * mas, 20 * mas);
}

// HYG v4.1 gives ra and dec once more in radians (columns rarad, decrad): Sirius 1.7677953696,
// -0.2917512585.
TEST(StarFile, HygByHeaderNamesWithoutTheSun) {
  const std::string path = test::data_path("stars/hygdata_v41_format_sample.csv");
  DMISE_NEEDS_FILE(path);
  const StarReading stars = read(path);
  const StarCatalogue& c = stars.catalogue;
  ASSERT_EQ(c.size(), 4u);
  EXPECT_EQ(c.id[0], 32263u);
  EXPECT_NEAR(c.ra_rad[0], 1.7677953696021995, 3e-8);
  EXPECT_NEAR(c.dec_rad[0], -0.291751258517685, 2e-8);
  EXPECT_NEAR(c.pm_ra_cosdec_rad_per_yr[0], -0.0000026471311772, 1e-14);
  EXPECT_NEAR(c.parallax_rad[0], 379.2 * mas, 0.1 * mas);  // Hipparcos: 379.21
}

TEST(StarFile, HipparcosInHygOrder) {
  const std::string path = test::data_path("stars/hip118k_hyg_schema.csv.gz");
  DMISE_NEEDS_FILE(path);
  const StarReading stars = read(path);
  EXPECT_GT(stars.catalogue.size(), 117000u);
  EXPECT_EQ(stars.catalogue.size() + stars.problems.size(), 118216u);
}

TEST(StarFile, UnknownDistanceIsNoParallax) {
  const StarReading stars = parse_stars("ra,dec,mag,dist\n1,2,3,100000\n1,2,3,10\n", "x.csv");
  EXPECT_NEAR(stars.catalogue.parallax_rad[1], 0.1 * arcsec, 1e-15);
  EXPECT_TRUE(stars.catalogue.flags[0] & star_has_no_parallax);
}

TEST(StarFile, PlainCsvInAnyOrderWithItsOwnEpoch) {
  const StarReading stars = parse_stars(
      "# ours\r\nmag_v,dec_deg,ra_deg,epoch_jyear,pm_ra_mas_per_yr,pm_dec_mas_per_yr\r\n"
      "9.5,4.66828815,269.45402305,1991.25,-797.84,10326.93\r\n",
      "x.csv");
  ASSERT_EQ(stars.catalogue.size(), 1u);
  EXPECT_NEAR(stars.catalogue.dec_rad[0], dms(4, 41, 36.2072), 20 * mas);  // SIMBAD, J2000.0
}

TEST(StarFile, BadLinesAreNamedAndTheRestIsKept) {
  const StarReading stars = parse_stars(
      "ra_deg,dec_deg,mag_v,bv\n10,20,3,0.1\n10,120,3,\nten,20,3,\n10,20\n10,20,3,blue\n11,21,4,\n",
      "my.csv");
  EXPECT_EQ(stars.catalogue.size(), 2u);
  EXPECT_THAT(stars.problems, ElementsAre("my.csv:3: declination must be in [-90, 90] deg",
                                          "my.csv:4: ra_deg: must be a number, got 'ten'",
                                          "my.csv:5: mag_v: must be a number, got ''",
                                          "my.csv:6: bv: must be a number, got 'blue'"));
}

// Truth and detections name stars by their numbers.
TEST(StarFile, NumbersOfStarsAreTheirOwn) {
  const StarReading stars = parse_stars(
      "ra_deg,dec_deg,mag_v,id,pm_ra_mas_per_yr,pm_dec_mas_per_yr\n10,20,3,4294967295,,\n"
      "11,20,3,5000000000,,\n12,20,3,-3,,\n13,20,3,1.5,,\n14,20,3,7,,\n15,20,3,7,,\n"
      "16,20,3,8,100,\n",
      "my.csv");
  EXPECT_THAT(stars.catalogue.id, ElementsAre(4294967295, 7));
  const std::string whole = "id: must be a whole number from 0 to 4294967295";
  EXPECT_THAT(stars.problems,
              ElementsAre("my.csv:3: " + whole, "my.csv:4: " + whole, "my.csv:5: " + whole,
                          "my.csv:7: id: another star has it",
                          "my.csv:8: pm_ra_mas_per_yr, pm_dec_mas_per_yr: must be given together"));
}

// Numbers in the columns that the Bright Star Catalogue has its own in.
TEST(StarFile, ATableWithBlanksIsNotTheBrightStarCatalogue) {
  std::string row(120, ' ');
  row.replace(0, 4, "  11").replace(102, 5, " 3.21").replace(60, 9, "12.345678");
  EXPECT_THROW(parse_stars("# %ECSV 1.0\n" + row + "\n", "table.ecsv"), ConfigError);
}

TEST(StarFile, WhatIsNoCatalogueIsRefusedWithItsName) {
  for (const char* text : {"", "hello\n", "ra_deg,dec_deg\n1,2\n", "ra_deg,dec_deg,mag_v\n"}) {
    try {
      parse_stars(text, "some.file");
      ADD_FAILURE() << text;
    } catch (const ConfigError& error) {
      EXPECT_THAT(error.what(), HasSubstr("some.file"));
    }
  }
}

// Cut at any length, a catalogue is read or refused but nothing breaks.
TEST(StarFile, TruncatedLines) {
  const std::string line =
      "064508.92 -164258.0 -000546.0-001223.100379.2 -1.4400.01A0 1            , alp CMa, Sirius";
  for (std::size_t n = 0; n <= line.size(); ++n)
    EXPECT_EQ(parse_kstars(line.substr(0, n), "x").catalogue.size(), n >= 56 ? 1u : 0u) << n;
}

}  // namespace
}  // namespace dmise
