#include "core/sky/bodies/shadow.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/base/error.h"
#include "core/base/units.h"

namespace dmise {
namespace {

const OblateEarth earth;
const Vec<Gcrs> sun_m{au_m, 0, 0};

double sunlit_fraction(const Vec<Gcrs>& object_m, const Vec<Gcrs>& to_sun_m,
                       const OblateEarth& of) {
  return EarthShadow(to_sun_m, of).sunlit_fraction(object_m);
}

// Reference: rays to 400,000 points of the solar disc, tests/reference/shadow.py.
TEST(Shadow, AgreesWithRaysToTheSolarDisc) {
  const struct {
    Vec<Gcrs> object_m, sun_m;
    double fraction;
  } rows[] = {
#include "tests/sky/shadow_reference.inc"
  };
  for (const auto& row : rows) {
    const double height_m = norm(row.object_m) - 6.378e6;
    EXPECT_NEAR(sunlit_fraction(row.object_m, row.sun_m, earth), row.fraction, 2e-3) << height_m;
  }
}

// Crosses the shadow's edge on a circle of radius r; `tilt` puts it towards the pole.
Vec<Gcrs> behind(double r, double angle, double tilt) {
  return {-r * std::cos(angle), r * std::sin(angle) * std::cos(tilt),
          r * std::sin(angle) * std::sin(tilt)};
}

TEST(Shadow, IsContinuousAndMonotoneThroughThePenumbra) {
  for (const double r : {6.4e6, 6.93e6, 2.66e7, 4.2164e7, 4e8})
    for (const double tilt : {0.0, 0.5, 1.5707963267948966, -1.2}) {
      const EarthShadow shadow(sun_m, earth);
      // From the middle of the shadow to broad daylight.
      const double step = 0.2 * 0.00465 / 200;  // a thousandth of the Sun's disc
      const double edge = std::asin(std::min(1.0, 6.378137e6 / r));
      double before = shadow.sunlit_fraction(behind(r, std::max(0.0, edge - 0.06), tilt));
      if (r < 1e8) {
        EXPECT_EQ(before, 0.0);
      }
      for (double x = std::max(0.0, edge - 0.06); x < std::min(edge + 0.03, 3.0); x += step) {
        const double lit = shadow.sunlit_fraction(behind(r, x, tilt));
        ASSERT_TRUE(lit >= before - 1e-9 && lit <= before + 0.01)
            << r << " " << tilt << " " << x << ": " << before << " to " << lit;
        before = lit;
      }
      EXPECT_EQ(before, 1.0);
    }
}

TEST(Shadow, SunEarthObjectAlignedIsDarkInFrontOfTheConesEndAndARingBehindIt) {
  for (const double r : {6.4e6, 4.2e7, 3.8e8, 1.3e9}) {
    EXPECT_EQ(sunlit_fraction({-r, 0, 0}, sun_m, earth), 0.0) << r;
    EXPECT_EQ(sunlit_fraction({r, 0, 0}, sun_m, earth), 1.0) << r;
    EXPECT_EQ(sunlit_fraction({0, 0, r}, {0, 0, -au_m}, earth), 0.0) << r;
  }
  // Twice as far as the umbra reaches the ring is what the two angular sizes leave.
  const double r = 2.8e9;
  const double sizes = (6.37e6 / r) / (6.957e8 / (au_m + r));
  EXPECT_NEAR(sunlit_fraction({-r, 0, 0}, sun_m, earth), 1 - sizes * sizes, 2e-3);
  EXPECT_NEAR(sunlit_fraction({-r, 1.0, 0}, sun_m, earth), 1 - sizes * sizes, 2e-3);
}

TEST(Shadow, AnObjectOnTheTerminatorHasHalfASun) {
  const double h = 1.0;
  EXPECT_NEAR(sunlit_fraction({0, 6378137.0 + h, 0}, sun_m, earth), 0.5, 0.15);
  EXPECT_NEAR(sunlit_fraction({0, 0, wgs84.polar_radius_m() + h}, sun_m, earth), 0.5, 0.15);
}

TEST(Shadow, FlatteningMovesTheEdgeByTwentyKilometresAtThePole) {
  const double between = 0.5 * (6378137.0 + wgs84.polar_radius_m());
  const double x = -7e5;
  EXPECT_LT(sunlit_fraction({x, between, 0}, sun_m, earth), 0.01);
  EXPECT_GT(sunlit_fraction({x, 0, between}, sun_m, earth), 0.99);
  const OblateEarth tipped{.pole = {0, 1, 0}};
  EXPECT_GT(sunlit_fraction({x, between, 0}, sun_m, tipped), 0.99);
}

TEST(Shadow, InsideTheEarthIsAnErrorThatNamesThePlace) {
  try {
    sunlit_fraction({1000, 2000, -3000}, sun_m, earth);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("(1000, 2000, -3000)"), std::string::npos);
  }
  EXPECT_THROW(sunlit_fraction({std::nan(""), 0, 0}, sun_m, earth), Error);
}

TEST(Shadow, ACatalogueGetsTheSameNumbersAndABadObjectHarmsNoOther) {
  std::vector<Vec<Gcrs>> objects;
  for (int i = 0; i < 3000; ++i)
    objects.push_back(from_spherical<Gcrs>(0.37 * i, 1.5 * std::sin(1.3 * i)) *
                      (6.6e6 + 4e7 * (i % 7) / 7));
  objects[5] = {};
  objects[6] = {std::nan(""), 0, 0};
  const std::size_t n = objects.size();
  std::vector<double> position_m(3 * n), lit(n);
  for (std::size_t i = 0; i < n; ++i) {
    position_m[i] = objects[i].x;
    position_m[n + i] = objects[i].y;
    position_m[2 * n + i] = objects[i].z;
  }
  const EarthShadow shadow(sun_m, earth);
  EXPECT_EQ(shadow.sunlit_fractions(position_m, lit), 2u);
  EXPECT_EQ(lit[5], 0.0);
  EXPECT_EQ(lit[6], 0.0);
  for (std::size_t i = 7; i < n; ++i) EXPECT_EQ(lit[i], shadow.sunlit_fraction(objects[i])) << i;
}

}  // namespace
}  // namespace dmise
