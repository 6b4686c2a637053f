#include "core/sky/stars/gaia_stars.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/sky/stars/star_file.h"
#include "tests/sky/gaia_table.h"
#include "tests/support/config_error.h"

namespace dmise {
namespace {

using test::barnards_table;
using test::fits_table;

// Gaia DR3's G and BP - RP beside SIMBAD's V and B-V.
TEST(GaiaStars, GiveJohnsonsLightOfStarsThatBothHaveMeasured) {
  struct Star {
    const char* name;
    double g, bp_rp, v, bv;
  };
  for (const Star& s :
       {Star{"HD 209458", 7.51, 0.754, 7.63, 0.59}, Star{"HD 189733", 7.41, 1.10, 7.65, 0.93},
        Star{"61 Cygni A", 4.77, 1.456, 5.21, 1.18}}) {
    const JohnsonLight light = johnson_of_gaia(s.g, s.bp_rp);
    EXPECT_NEAR(light.v_mag, s.v, 0.05) << s.name;
    EXPECT_NEAR(light.bv, s.bv, 0.12) << s.name;
  }
  // The Sun: Casagrande & VandenBerg 2018, MNRAS 479, L102.
  EXPECT_NEAR(johnson_of_gaia(-26.90, 0.82).v_mag, -26.76, 0.03);
}

constexpr const char* barnard =
    "source_id,ref_epoch,ra,dec,parallax,pmra,pmdec,phot_g_mean_mag,bp_rp\n"
    "4472832130942575872,2016.0,269.44850252543836,4.739420051112412,546.9759,-801.551,10362.394,"
    "8.193974,2.833697\n";

// Barnard's star in 2016 by Gaia DR3, and at J2000.0 by SIMBAD.
void expect_barnard(const StarCatalogue& c) {
  ASSERT_EQ(c.size(), 1u);
  EXPECT_NEAR(c.ra_rad[0], 269.452077 * deg, 0.02 * arcsec);
  EXPECT_NEAR(c.dec_rad[0], 4.693364 * deg, 0.02 * arcsec);
  EXPECT_NEAR(c.pm_dec_rad_per_yr[0], 10362.4 * mas, 0.5 * mas);
  EXPECT_NEAR(c.parallax_rad[0], 546.98 * mas, 0.1 * mas);
  EXPECT_NEAR(c.v_mag[0], 9.51, 0.1);
}

TEST(GaiaStars, AreReadOfCsvAndMovedToJ2000) {
  const StarReading read = parse_stars(barnard, "gaia.csv");
  EXPECT_TRUE(read.problems.empty());
  expect_barnard(read.catalogue);
  EXPECT_EQ(
      parse_stars("# %ECSV 1.0\n# ---\n# delimiter: ','\n" + std::string(barnard), "gaia.ecsv"),
      read);
}

TEST(GaiaStars, WhatIsMissingIsFlaggedAndWhatIsWrongIsNamed) {
  const StarReading read = parse_stars(
      "ra,dec,phot_g_mean_mag,bp_rp,pmra,pmdec,parallax\n"
      "10,20,15,null,null,null,null\n"
      "10,20,null,1,0,0,0\n"
      "10,20,15,x,0,0,0\n"
      "10,nan,15,1,0,0,0\n"
      "10,20,15,1,nan,0,-3\n",
      "gaia.csv");
  EXPECT_EQ(read.problems,
            (std::vector<std::string>{"gaia.csv:3: phot_g_mean_mag: must be a number",
                                      "gaia.csv:4: bp_rp: must be a number, got 'x'",
                                      "gaia.csv:5: declination must be in [-90, 90] deg"}));
  ASSERT_EQ(read.catalogue.size(), 2u);
  EXPECT_EQ(read.catalogue.flags[0],
            star_has_no_colour | star_has_no_parallax | star_has_no_proper_motion);
  EXPECT_EQ(read.catalogue.flags[1], star_has_no_parallax | star_has_no_proper_motion);
}

TEST(GaiaStars, AreReadOfBinaryTablesOfFits) {
  const StarReading read = parse_stars(barnards_table(), "gaia.fits");
  EXPECT_TRUE(read.problems.empty());
  expect_barnard(read.catalogue);
}

TEST(GaiaStars, MissingValuesOfATableAreNaN) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const StarReading read =
      parse_stars(fits_table({"ra", "dec", "phot_g_mean_mag", "bp_rp"}, {"D", "D", "E", "E"},
                             {{1, 2}, {3, 4}, {nan, 15}, {1, nan}}),
                  "gaia.fits");
  EXPECT_EQ(read.problems,
            std::vector<std::string>{"gaia.fits: row 1: phot_g_mean_mag: must be a number"});
  ASSERT_EQ(read.catalogue.size(), 1u);
  EXPECT_TRUE(read.catalogue.flags[0] & star_has_no_colour);
}

std::string problem_of(const std::string& bytes) {
  return test::config_error_of([&] { parse_stars(bytes, "gaia.fits"); });
}

TEST(GaiaStars, TablesThatAreNoCatalogueAreRefusedInALine) {
  EXPECT_EQ(problem_of(fits_table({"ra", "dec"}, {"D", "D"}, {{1}, {2}})),
            "gaia.fits: the table has no column phot_g_mean_mag");
  EXPECT_EQ(problem_of(fits_table({"ra", "dec", "phot_g_mean_mag"}, {"D", "8A", "E"}, {{1}})),
            "gaia.fits: column dec must hold one number a row");
  const std::string whole = barnards_table();
  constexpr std::size_t rows_end = 5760 + 80;  // headers and rows; then padding
  for (std::size_t size = 0; size < rows_end; size += 80) {
    const std::string problem = problem_of(whole.substr(0, size));
    EXPECT_TRUE(problem.starts_with("gaia.fits: ")) << size << " " << problem;
    EXPECT_EQ(problem.find('\n'), problem.npos);
  }
  EXPECT_EQ(problem_of(whole.substr(0, 5760)), "gaia.fits: is truncated: 5760 of 8640 bytes");
  EXPECT_EQ(parse_stars(whole.substr(0, rows_end), "gaia.fits").catalogue.size(),
            parse_stars(whole, "gaia.fits").catalogue.size());
}

}  // namespace
}  // namespace dmise
