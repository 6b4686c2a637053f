#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"
#include "sensors/planning/exposure_planner.h"
#include "tests/pipeline/harness.h"

namespace dmise {
namespace {

constexpr double half_diagonal_rad = 4.8 * deg;  // as geo-watch has it

struct Field {
  std::string pointing = "{azimuth_deg: 168.7, elevation_deg: 52}", start = "2018-01-21T00:15:00Z";
  std::string star = "49.7,-5.4,6,0.65,0,0";  // in the middle of that field
  double exposure_s = 5.0;

  PlanFacts facts() const {
    const test::Stage stage(
        "simulation: {start: " + start +
            ", duration_s: 30, tick_s: 5}\n"
            "stars: {catalogue: stars.csv, faintest_mag: 15}\n"
            "sensors:\n  - {name: watch, site: savannah, camera: geo-watch, pointing: " +
            pointing + ", exposure_s: " + std::to_string(exposure_s) + ", cadence_s: 10}\n",
        "ra_deg,dec_deg,mag_v,bv,pm_ra_mas_per_yr,pm_dec_mas_per_yr\n" + star + "\n");
    const SensorConfig& sensor = stage.scenario.sensors.at(0);
    const ExposurePlanner planner(sensor, stage.stars.get(), stage.scenario.faintest_star_mag,
                                  nullptr);
    return planner.facts(View(sensor, frame_times(sensor, 1), stage.states), {});
  }
};

TEST(StarFacts, AStarCountsWhereItIsInTheFrame) {
  const PlanFacts f = Field{}.facts();
  EXPECT_GT(f.brightest_star_e, 0.0);
  EXPECT_DOUBLE_EQ(f.brightest_left_e[f.limit(5)], f.brightest_star_e);  // left out by that limit
  EXPECT_EQ(f.brightest_left_e[f.limit(6)], 0.0);                        // drawn within this
  EXPECT_EQ(f.stars_to(5), 0.0);
  EXPECT_GE(f.stars_to(6), 1.0);
  EXPECT_EQ(Field{.star = "49.7,-25.4,6,0.65,0,0"}.facts().brightest_star_e, 0.0);
}

TEST(StarFacts, FiveMagnitudesAreAFactorOfAHundred) {
  const double bright_e = Field{.star = "49.7,-5.4,6,0.65,0,0"}.facts().brightest_star_e,
               faint_e = Field{.star = "49.7,-5.4,11,0.65,0,0"}.facts().brightest_star_e;
  EXPECT_NEAR(bright_e / faint_e, 100.0, 1e-6);
}

// 15.041 arcsec/s on the equator.
TEST(StarFacts, StarsTrailAtTheSiderealRateUnlessTheyAreFollowed) {
  const PlanFacts f = Field{}.facts();
  const double px_per_s = 15.041 * arcsec * std::cos(5.4 * deg) / f.pixel_rad;
  EXPECT_NEAR(f.star_trail_px / (5.0 * px_per_s), 1.0, 0.02);
  EXPECT_NEAR(Field{.exposure_s = 2.5}.facts().star_trail_px / f.star_trail_px, 0.5, 0.01);
  const PlanFacts followed =
      Field{.pointing = "{azimuth_deg: 168.7, elevation_deg: 52, tracking: sidereal}"}.facts();
  EXPECT_LT(followed.star_trail_px, 0.5);
}

TEST(StarFacts, ProperMotionHasGoneOnSinceTheCataloguesEpoch) {
  const double years = 18.05;  // from J2000
  EXPECT_NEAR(Field{.star = "49.7,-5.4,6,0.65,600,-800"}.facts().star_shift_rad,
              years * 1.0 * arcsec, 0.02 * years * arcsec);
  EXPECT_EQ(Field{}.facts().star_shift_rad, 0.0);
}

TEST(SkyFacts, ASampleIsTheSumOfItsPartsAndItsNoise) {
  const PlanFacts f = Field{}.facts();
  ASSERT_EQ(f.sky.size(), 25u);
  for (const SkySample& s : f.sky) {
    double sum_e = 0.0;
    for (const double e : s.part_e) {
      EXPECT_GE(e, 0.0);
      sum_e += e;
    }
    EXPECT_NEAR(sum_e / s.sky_e, 1.0, 1e-12);
    EXPECT_GE(s.noise_e * s.noise_e, s.sky_e + f.dark_e + f.read_noise_e * f.read_noise_e);
  }
}

TEST(SkyFacts, TheHorizonIsSeenWhereTheFieldReachesIt) {
  const PlanFacts high = Field{}.facts();
  EXPECT_FALSE(high.sees_horizon);
  const double lowest_rad = 52.0 * deg - half_diagonal_rad;
  EXPECT_GT(high.max_airmass, 1.0 / std::sin(52.0 * deg));
  EXPECT_LT(high.max_airmass, 1.0 / std::sin(lowest_rad));
  const PlanFacts low = Field{.pointing = "{azimuth_deg: 168.7, elevation_deg: 12}"}.facts();
  EXPECT_FALSE(low.sees_horizon);
  EXPECT_GT(low.max_airmass, 4.6);  // 4.71 at 12 deg (Kasten and Young 1989)
  EXPECT_TRUE(Field{.pointing = "{azimuth_deg: 168.7, elevation_deg: 1}"}.facts().sees_horizon);
}

// What is not drawn star by star is in the smooth starlight.
TEST(SkyFacts, StarlightGrowsAsFewerStarsAreDrawn) {
  const PlanFacts f = Field{.star = "49.7,-5.4,12,0.65,0,0"}.facts();
  EXPECT_GT(f.starlight_e[0], 0.0);
  for (std::size_t m = 1; m < f.starlight_e.size(); ++m)
    EXPECT_LE(f.starlight_e[m], f.starlight_e[m - 1]) << m;
  EXPECT_EQ(f.starlight_e[15], 0.0);
}

TEST(SkyFacts, RefractionIsThatOfTheLowestDirection) {
  // 58.3 arcsec x cot(elevation) at sea level (Bennett 1982).
  const PlanFacts f = Field{}.facts();
  EXPECT_GT(f.refraction_rad / arcsec, 58.3 / std::tan(52.0 * deg));
  EXPECT_LT(f.refraction_rad / arcsec, 58.3 / std::tan(52.0 * deg - half_diagonal_rad));
}

}  // namespace
}  // namespace dmise
