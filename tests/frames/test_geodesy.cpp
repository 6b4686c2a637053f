#include "core/frames/geodesy.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/directions.h"

namespace dmise {
namespace {

// Reference: ERFA in Python, tests/reference/earth_orientation.py, eraGd2gc for WGS 84.
TEST(Geodesy, AgreesWithErfa) {
  const auto expect = [](const Site& site, const Vec<Itrs>& m) {
    EXPECT_LT(norm(itrs_from_geodetic(site) - m), 2e-8 * (1 + norm(m) / 1e7));
  };
  expect({33.777, -84.398, 300.0}, {518086.0531402426, -5281951.829710651, 3526080.040952069});
  expect({90.0, 0.0, 0.0}, {0, 0, 6356752.314245179});
  expect({-45.0, 180.0, 35786e3}, {-29822114.15039072, 0, -29791871.68040771});
  expect({-0.001, 70.0, -400.0}, {2181314.522503412, 5993112.395306564, -110.5672944990857});
}

TEST(Geodesy, RoundTripIsExactToTensOfNanometres) {
  for (double latitude = -90; latitude <= 90; latitude += 7.5)
    for (double longitude = -180; longitude < 180; longitude += 36)
      for (double height : {-400.0, 0.0, 300.0, 550e3, 2000e3, 35786e3}) {
        const Vec<Itrs> r = itrs_from_geodetic({latitude, longitude, height});
        const Site back = geodetic_from_itrs(r);
        EXPECT_LT(norm(itrs_from_geodetic(back) - r), height > 2000e3 ? 5e-8 : 1e-8)
            << latitude << " " << longitude << " " << height;
        EXPECT_NEAR(back.height_m, height, height > 2000e3 ? 5e-8 : 1e-8);
      }
}

TEST(Geodesy, UpIsTheNormalAndEastIsLevel) {
  const Site site{33.777, -84.398, 300.0};
  const Rotation<Enu, Itrs> enu = enu_from_itrs(site);
  const Vec<Itrs> above = itrs_from_geodetic({33.777, -84.398, 1300.0}) - itrs_from_geodetic(site);
  EXPECT_NEAR((enu * above).z, 1000.0, 1e-8);
  const Vec<Enu> east =
      enu * Vec<Itrs>{-std::sin(site.longitude_deg * deg), std::cos(site.longitude_deg * deg), 0.0};
  EXPECT_NEAR(east.x, 1.0, 1e-15);
  EXPECT_NEAR((enu * Vec<Itrs>{0, 0, 1}).y, std::cos(site.latitude_deg * deg), 1e-15);
}

TEST(Geodesy, AxesAreDefinedAtThePolesAndTheDateLine) {
  for (const Site& site : {Site{90, 0, 0}, Site{-90, 30, 0}, Site{0, 180, 0}, Site{0, -540, 0}}) {
    const Rotation<Enu, Itrs> enu = enu_from_itrs(site);
    const Rotation<Enu, Enu> one = enu * enu.inverse();
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) EXPECT_NEAR(one.m[i][j], i == j, 1e-15);
  }
}

TEST(Geodesy, AzimuthRunsFromNorthThroughEast) {
  EXPECT_NEAR(horizontal({1, 0, 0}).azimuth_rad, 90 * deg, 1e-15);
  EXPECT_NEAR(horizontal({-1, 0, 0}).azimuth_rad, 270 * deg, 1e-15);
  EXPECT_LT(horizontal({-1e-30, 1, 0}).azimuth_rad, 2 * pi);
  EXPECT_EQ(horizontal({0, 0, 5}).azimuth_rad, 0.0);
  EXPECT_NEAR(horizontal({0, 0, 5}).elevation_rad, 90 * deg, 1e-15);
  for (double azimuth = 0; azimuth < 360; azimuth += 11.25)
    for (double elevation = -88; elevation < 90; elevation += 8) {
      const Horizontal h = horizontal(from_horizontal({azimuth * deg, elevation * deg}) * 7e5);
      EXPECT_NEAR(h.azimuth_rad, azimuth * deg, 1e-13);
      EXPECT_NEAR(h.elevation_rad, elevation * deg, 1e-15);
    }
}

TEST(Geodesy, NonsenseIsRefused) {
  EXPECT_THROW(itrs_from_geodetic({90.1, 0, 0}), Error);
  EXPECT_THROW(itrs_from_geodetic({0, std::nan(""), 0}), Error);
  EXPECT_THROW(itrs_from_geodetic({0, 0, 0, {-1.0, 0.0}}), Error);
  EXPECT_THROW(geodetic_from_itrs({std::nan(""), 0, 0}), Error);
}

}  // namespace
}  // namespace dmise
