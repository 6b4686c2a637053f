#include "core/sky/bodies/occultation.h"

#include <gtest/gtest.h>

#include "core/base/units.h"
#include "tests/support/directions.h"

namespace dmise {
namespace {

const OblateEarth earth;
constexpr double a = 6378137.0;
const double b = wgs84.polar_radius_m();

bool is_clear(const Vec<Gcrs>& p, const Vec<Gcrs>& q) { return FreeSight(p, earth).clear(q); }

// By walking along the line: the definition, slowly.
bool clear_by_steps(const Vec<Gcrs>& p, const Vec<Gcrs>& q) {
  constexpr int steps = 20000;
  for (int i = 0; i <= steps; ++i) {
    const Vec<Gcrs> r = p + (q - p) * (static_cast<double>(i) / steps);
    if ((r.x * r.x + r.y * r.y) / (a * a) + r.z * r.z / (b * b) < 1.0) return false;
  }
  return true;
}

TEST(Occultation, AgreesWithWalkingAlongTheLine) {
  int blocked = 0;
  for (int i = 0; i < 200; ++i) {
    const Vec<Gcrs> p = from_spherical<Gcrs>(1.7 * i, 1.5 * std::sin(0.7 * i)) * 6.93e6;
    const Vec<Gcrs> q = from_spherical<Gcrs>(0.3 * i, 1.5 * std::sin(2.1 * i)) * (7e6 + 1.7e5 * i);
    EXPECT_EQ(is_clear(p, q), clear_by_steps(p, q)) << i;
    EXPECT_EQ(is_clear(p, q), is_clear(q, p)) << i;
    blocked += !is_clear(p, q);
  }
  EXPECT_GT(blocked, 40);
  EXPECT_LT(blocked, 160);
}

TEST(Occultation, ALineOverThePoleClearsTheFlatteningToAMetre) {
  for (const double height : {-1.0, 1.0}) {
    const Vec<Gcrs> p{-3e7, 0, b + height}, q{3e7, 0, b + height};
    EXPECT_EQ(is_clear(p, q), height > 0);
    const Vec<Gcrs> e{-3e7, a + height, 0}, f{3e7, a + height, 0};
    EXPECT_EQ(is_clear(e, f), height > 0);
  }
}

TEST(Occultation, AGroundSiteSeesWhatStandsOverItsTangentPlane) {
  for (const double height : {-400.0, 0.0})
    for (const double latitude : {-90.0, -45.0, 0.0, 33.777}) {
      const Site site{latitude, 20.0, height};
      const Vec<Itrs> r = itrs_from_geodetic(site);
      const FreeSight sight({r.x, r.y, r.z}, earth);
      for (const double elevation : {-1.0, -0.02, 0.02, 1.0, 89.0, 90.0}) {
        const Vec<Itrs> d = enu_from_itrs(site).inverse() * from_horizontal({1.0, elevation * deg});
        const Vec<Gcrs> direction{d.x, d.y, d.z};
        EXPECT_EQ(sight.clear_direction(direction), elevation > 0) << latitude << " " << elevation;
        EXPECT_EQ(sight.clear(Vec<Gcrs>{r.x, r.y, r.z} + direction * 4e7), elevation > 0);
      }
    }
}

TEST(Occultation, AMountainSeesBelowLevelDownToItsDip) {
  const FreeSight sight({a + 3000.0, 0, 0}, earth);
  const double dip = std::acos(a / (a + 3000.0));
  EXPECT_TRUE(sight.clear_direction({-std::sin(dip - 1e-6), std::cos(dip - 1e-6), 0}));
  EXPECT_FALSE(sight.clear_direction({-std::sin(dip + 1e-6), std::cos(dip + 1e-6), 0}));
}

TEST(Occultation, SunEarthObjectAlignedIsBlockedAndNothingIsNan) {
  const FreeSight sight({7e6, 0, 0}, earth);
  EXPECT_FALSE(sight.clear_direction({-1, 0, 0}));
  EXPECT_TRUE(sight.clear_direction({1, 0, 0}));
  EXPECT_FALSE(sight.clear({-7e6, 0, 0}));
  EXPECT_TRUE(sight.clear({7e6, 0, 0}));  // the place itself
  EXPECT_FALSE(sight.clear({0, 0, 0}));   // an object without a state
  EXPECT_TRUE(sight.clear({6.9e6, 0, 0}));
}

}  // namespace
}  // namespace dmise
