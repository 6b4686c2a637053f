#include "core/time/iers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "core/base/error.h"
#include "core/base/units.h"
#include "tests/support/data.h"

namespace dmise {
namespace {

constexpr double us = 1e-6;

std::string write_temporary(const std::string& content) {
  const std::string path = testing::TempDir() + "dmise_iers_" +
                           testing::UnitTest::GetInstance()->current_test_info()->name();
  std::ofstream(path) << content;
  return path;
}

// Three lines of the IERS' finals2000A; the middle one without Bulletin B.
const std::string lines =
    "18 3 6 58183.00 I  0.006568 0.000019  0.354259 0.000019  I 0.1604839 0.0000114  1.0066 0.0040 "
    " I     0.263    0.256    -0.073    0.068  0.006531  0.354263  0.1604862     0.283    -0.044  "
    "\n"
    "18 3 7 58184.00 I  0.007282 0.000019  0.356648 0.000021  I 0.1595412 0.0000056\n"
    "18 3 8 58185.00\n";

TEST(IersTable, PrefersBulletinBAndFallsBackToA) {
  const IersTable table = IersTable::read_finals2000a(write_temporary(lines));
  EXPECT_EQ(table.first_mjd(), 58183);
  EXPECT_EQ(table.last_mjd(), 58184);
  EXPECT_NEAR(table.at(58183.0)->ut1_minus_tai_s, 0.1604862 - 37.0, 1e-3 * us);
  EXPECT_NEAR(table.at(58184.0)->ut1_minus_tai_s, 0.1595412 - 37.0, 1e-3 * us);
  EXPECT_NEAR(table.at(58183.0)->polar_motion_y_rad, 0.354263 * arcsec, 1e-6 * arcsec);
  EXPECT_NEAR(table.at(58183.5)->polar_motion_x_rad, 0.5 * (0.006531 + 0.007282) * arcsec,
              1e-6 * arcsec);
}

TEST(IersTable, GivesNothingBeyondItsEnds) {
  const IersTable table = IersTable::read_finals2000a(write_temporary(lines));
  EXPECT_FALSE(table.at(58182.999));
  EXPECT_FALSE(table.at(58184.001));
  EXPECT_FALSE(table.at(std::nan("")));
}

TEST(IersTable, AnotherKindOfFileIsRefusedWithItsLine) {
  try {
    IersTable::read_finals2000a(write_temporary("mjd,x,y\n58183,0,0\n"));
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find(":1: no modified Julian date"), std::string::npos);
  }
}

// Reference: astropy iers.IERS_A on the same file: ut1_utc, pm_xy at MJD 57753.75, which is before
// the leap second of 2016-12-31, and 57754.25, after it (tests/reference/earth_rotation.py).
TEST(IersTable, AgreesWithAstropyAcrossALeapSecond) {
  const std::string path = test::data_path("eop/finals2000A.all.gz");
  DMISE_NEEDS_FILE(path);
  const IersTable table = IersTable::read_finals2000a(path);
  EXPECT_EQ(table.first_mjd(), 41684);
  const auto before = table.at(57753.75), after = table.at(57754.25);
  EXPECT_NEAR(before->ut1_minus_tai_s + 36.0, -0.408466867, us);
  EXPECT_NEAR(after->ut1_minus_tai_s + 37.0, 0.591026850, us);
  EXPECT_NEAR(after->polar_motion_x_rad, 0.080406250 * arcsec, 1e-5 * arcsec);
  EXPECT_NEAR(after->polar_motion_y_rad, 0.263204250 * arcsec, 1e-5 * arcsec);
}

}  // namespace
}  // namespace dmise
