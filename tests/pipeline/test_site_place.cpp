#include <map>

#include "core/base/units.h"
#include "core/image/fits_cards.h"
#include "core/sky/places/place_effects.h"
#include "tests/pipeline/wiring.h"

namespace dmise {
namespace {

// Two lines of the IERS' finals2000A.
const std::string finals =
    "18 3 6 58183.00 I  0.006568 0.000019  0.354259 0.000019  I 0.1604839 0.0000114  1.0066 0.0040 "
    " I     0.263    0.256    -0.073    0.068  0.006531  0.354263  0.1604862     0.283    -0.044  "
    "\n"
    "18 3 7 58184.00 I  0.007282 0.000019  0.356648 0.000021  I 0.1595412 0.0000056\n";

// Reference: ERFA's eraC2t06a and eraGd2gc, by tests/reference/wiring.py. With UTC for UT1 the site
// would be 64 m away, without polar motion 11 m.
TEST(SitePlace, IsByTheUt1AndPoleOfTheEarthOrientationFile) {
  const auto path = std::filesystem::path(testing::TempDir()) / "finals.txt";
  std::ofstream(path) << finals;
  test::Stage stage(test::scenario(
      "2018-03-06T11:59:55Z", 20,
      "site: {latitude_deg: -30.2, longitude_deg: -70.7, height_m: 2000}", test::camera(8, 8, 0.1),
      "zenith", 10, 20, "", ", earth_orientation: " + path.string()));
  const Vec<Gcrs> place_m{306478.024, -5509942.319, -3191264.754};
  const auto& sensor = stage.scenario.sensors[0];
  const View view(sensor, frame_times(sensor, 1), stage.states);
  EXPECT_LT(norm(view.observer(view.times().middle).position_m - place_m), 0.02);
  const auto frame = stage.frame();
  EXPECT_LT(norm(frame.header.sensor_position_m - place_m), 0.02);
  EXPECT_LT(norm(frame.report.sensor_position_m - place_m), 0.02);
  std::filesystem::remove(path);
}

// Closed form: 10 s from the scenario's start.
TEST(SitePlace, TheFileSaysWhenTheExposureBeganAndEnded) {
  test::Stage stage(test::scenario("2018-03-06T11:59:55Z", 20, "site: atlanta",
                                   test::camera(8, 8, 0.1), "zenith", 10, 20));
  std::map<std::string, std::string> values;
  for (const auto& card : fits_cards(stage.frame().header)) add_card(values, card);
  EXPECT_EQ(values.at("DATE-BEG"), "2018-03-06T11:59:55.000000");
  EXPECT_EQ(values.at("DATE-AVG"), "2018-03-06T12:00:00.000000");
  EXPECT_EQ(values.at("DATE-END"), "2018-03-06T12:00:05.000000");
}

// Reference: ISO 2533, table 5: 794.95 hPa and 1.999 deg C at 2,000 m.
TEST(SitePlace, AtTwoThousandMetresHasTheAirOfThatHeight) {
  test::Stage stage(
      test::scenario("2018-03-06T12:00:00Z", 20,
                     "site: {latitude_deg: -30.2, longitude_deg: -70.7, height_m: 2000}",
                     test::camera(8, 8, 0.1), "zenith", 1, 5));
  const SiteState* air = stage.states.site("a", {});
  ASSERT_TRUE(air);
  EXPECT_NEAR(air->pressure_hpa, 794.95, 0.1);
  EXPECT_NEAR(air->temperature_c, 2.0, 0.01);
}

/// How much higher a star stands than without air, at an apparent elevation [arcsec].
double lift_arcsec(double centre_um, double elevation_rad) {
  test::Stage stage(test::scenario(
      "2018-03-06T12:00:00Z", 20, "site: atlanta", test::camera(8, 8, 0.1, "", "", centre_um),
      "zenith", 1, 5, ", weather: {pressure_hpa: 1000, temperature_c: -5, humidity: 0.3}"));
  const auto& sensor = stage.scenario.sensors[0];
  const View view(sensor, frame_times(sensor, 1), stage.states);
  const SimTime t = view.times().middle;
  EffectSet vacuum = sensor.effects;
  vacuum.set(AtmosphericRefraction::facts, false);
  // The star whose apparent elevation is the one asked for, by its place without air.
  StarPlace star;
  Vec<Gcrs> from = test::direction(view, 1.0, elevation_rad);
  const Vec<Gcrs> wanted = from;
  for (int i = 0; i < 8; ++i) {
    const auto [ra, dec] = to_spherical(from);
    star = {.ra_rad = ra, .dec_rad = dec};
    from = unit(from + wanted - view.places(t).star(star));
  }
  return angle_rad(view.places(t).star(star), view.places(t, vacuum).star(star)) / arcsec;
}

// Reference: ERFA's eraRefco by tests/reference/wiring.py.
TEST(SitePlace, RefractionIsThatOfTheCamerasBand) {
  const double b = lift_arcsec(0.438, 20 * deg), i = lift_arcsec(0.798, 20 * deg);
  EXPECT_NEAR(b, 167.3478, 0.01);
  EXPECT_NEAR(i, 163.8048, 0.01);
}

// Reference: ERFA's eraPmpx, eraLdsun and eraAb at the site, by tests/reference/wiring.py. Its
// parallax moves the star by 0.7 arcsec, the Earth's speed by 20.
TEST(SitePlace, AStarIsSeenFromThere) {
  test::Stage stage(
      test::scenario("2018-03-06T12:00:00Z", 20,
                     "site: {latitude_deg: -30.2, longitude_deg: -70.7, height_m: 2000}",
                     test::camera(8, 8, 0.1), "zenith", 10, 20, ", effects: {refraction: off}"));
  const auto& sensor = stage.scenario.sensors[0];
  const View view(sensor, frame_times(sensor, 1), stage.states);
  const StarPlace star{.ra_rad = 217.43 * deg,
                       .dec_rad = -62.68 * deg,
                       .pm_ra_cosdec_rad_per_yr = -3.775 * arcsec,
                       .pm_dec_rad_per_yr = 0.765 * arcsec,
                       .parallax_rad = 0.7687 * arcsec};
  const Vec<Gcrs> erfa{-0.3647049854, -0.2787947777, -0.8884051697};
  EXPECT_LT(angle_rad(view.places(view.times().middle).star(star), erfa), 5e-3 * arcsec);
  const auto header = stage.frame().header;
  ASSERT_TRUE(header.site);
  EXPECT_NEAR(header.site->latitude_rad / deg, -30.2, 1e-9);
  EXPECT_NEAR(header.site->longitude_rad / deg, -70.7, 1e-9);
}

// A sidereal mount meets its azimuth and elevation in mid exposure. Reference: the zenith of ERFA's
// eraAtco13 there (observed places without air), by its hour angle: right ascension is local
// sidereal time, 2 minutes of which pass in half of the exposure.
TEST(SitePlace, ASiderealMountIsAimedInMidExposure) {
  const auto boresight = [](double first_s) {
    test::Stage stage(test::scenario(
        "2018-03-06T12:00:00Z", 600, "site: atlanta", test::camera(64, 64, 0.1),
        "{azimuth_deg: 180, elevation_deg: 40, tracking: sidereal}", first_s > 0 ? 1 : 240, 300,
        ", first_exposure_s: " + std::to_string(first_s) + ", effects: {refraction: off}"));
    const auto report = stage.frame().report;
    return std::pair(report.boresight_ra_rad, report.boresight_dec_rad);
  };
  const auto [ra, dec] = boresight(0);              // 240 s about 120 s
  const auto [ra_now, dec_now] = boresight(119.5);  // 1 s about 120 s
  EXPECT_NEAR(std::remainder(ra - ra_now, 2 * pi), 0.0, 2 * arcsec);
  EXPECT_NEAR(dec, dec_now, 2 * arcsec);
}

}  // namespace
}  // namespace dmise
