#include <cmath>

#include "core/base/units.h"
#include "core/wcs/wcs.h"
#include "tests/pipeline/harness.h"

// Light lies where its label says: what is measured in the counts, against the place that the
// header's WCS or the truth gives.
namespace dmise {
namespace {

constexpr double tolerance_px = 0.01;

// GOES 16 and the ISS, element sets of 2018-01-20 as in `catalogue: demo`.
const std::string elements =
    "GOES 16\n"
    "1 41866U 16071A   18019.87773469 -.00000245  00000-0  00000-0 0  9992\n"
    "2 41866   0.0069 115.0916 0001074 269.6956 335.2025  1.00271237  4322\n"
    "ISS\n"
    "1 25544U 98067A   18020.89808844  .00002078  00000-0  38550-4 0  9992\n"
    "2 25544  51.6424  32.9776 0003646  28.7227  39.5332 15.54190080 95614\n";

const std::string quiet =
    "effects: {sky: off, photon_noise: off, dark_current: off, read_noise: off, full_well: off,"
    " quantisation: off}\n";

std::string scenario(const std::string& sensor, const std::string& objects = "[]") {
  return "simulation: {start: 2018-01-21T00:15:00Z, duration_s: 30, tick_s: 5}\nobjects: " +
         objects + "\nstars: {catalogue: stars.csv, faintest_mag: 15}\n" + quiet +
         "sensors:\n  - " + sensor + "\n";
}

/// For bench/report.py.
void record(double worst_px, int sources) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4f", worst_px);
  testing::Test::RecordProperty("worst_px", text);
  testing::Test::RecordProperty("sources", sources);
}

/// Stars of V = 9 (far below saturation) and no motion on a grid around a place.
std::string star_grid(double ra_deg, double dec_deg, double step_deg, int half) {
  std::string csv = "ra_deg,dec_deg,mag_v,bv,parallax_mas,pm_ra_mas_per_yr,pm_dec_mas_per_yr\n";
  for (int i = -half; i <= half; ++i)
    for (int j = -half; j <= half; ++j) {
      const double dec = dec_deg + j * step_deg;
      const double ra = std::fmod(ra_deg + i * step_deg / std::cos(dec * deg) + 720.0, 360.0);
      csv += std::to_string(ra) + "," + std::to_string(dec) + ",9,0.5,0,0,0\n";
    }
  return csv;
}

/// The worst distance of a star's light from where the WCS has its catalogue place.
double worst_star_px(test::Stage& stage, double radius_px, int& count) {
  const auto frame = stage.frame();
  double worst = 0;
  count = 0;
  const auto& stars = stage.stars->stars;
  for (std::size_t i = 0; i < stars.size(); ++i) {
    const auto at =
        wcs_pixel(frame.header.wcs, from_spherical<Gcrs>(stars.ra_rad[i], stars.dec_rad[i]));
    if (!at || at->x_px < radius_px || at->y_px < radius_px ||
        at->x_px > frame.counts.columns - 1 - radius_px ||
        at->y_px > frame.counts.rows - 1 - radius_px)
      continue;
    const auto measured = test::centroid(frame.counts, *at, radius_px);
    worst = std::max(worst, std::hypot(measured.x_px - at->x_px, measured.y_px - at->y_px));
    ++count;
  }
  record(worst, count);
  return worst;
}

TEST(Registration, StarsOfANarrowFieldFromOrbit) {
  test::Stage stage(
      scenario("{name: imager, platform: \"41866\", camera: wide-field-cmos, pointing: "
               "{ra_deg: 359.5, dec_deg: 20}, exposure_s: 5, cadence_s: 10}",
               "[{catalogue: objects.tle}]"),
      star_grid(359.5, 20, 1.1, 4), elements);
  int count = 0;
  EXPECT_LT(worst_star_px(stage, 12, count), tolerance_px);
  EXPECT_GT(count, 60);
}

TEST(Registration, TrailsOverNinetyDegreesFromTheGround) {
  // Boresight at declination +33.8, hour angle 0: sidereal time at 84.398 W, 00:15:10 UT is 40.2
  // deg.
  test::Stage stage(scenario("{name: allsky, site: atlanta, camera: omnissa, pointing: zenith, "
                             "exposure_s: 20, cadence_s: 30}"),
                    star_grid(40, 34, 5.7, 7));
  int count = 0;
  EXPECT_LT(worst_star_px(stage, 9, count), tolerance_px);
  EXPECT_GT(count, 80);
}

TEST(Registration, AroundTheCelestialPole) {
  test::Stage stage(scenario("{name: polar, site: atlanta, camera: wide-field-cmos, pointing: "
                             "{ra_deg: 123, dec_deg: 90}, exposure_s: 5, cadence_s: 10}"),
                    star_grid(123, 87, 0.9, 2));
  int count = 0;
  EXPECT_LT(worst_star_px(stage, 10, count), tolerance_px);
  EXPECT_GT(count, 15);
}

TEST(Registration, AGeostationaryPointAmongTrailingStars) {
  test::Stage stage(
      scenario("{name: watch, site: savannah, camera: geo-watch, pointing: {azimuth_deg: "
               "168.7, elevation_deg: 52}, exposure_s: 10, cadence_s: 30}",
               "[{catalogue: objects.tle, radius_m: 20}]"),
      "ra_deg,dec_deg,mag_v\n0,-80,6\n", elements);
  const auto frame = stage.frame();
  ASSERT_EQ(frame.truths.size(), 1u);
  const auto& truth = frame.truths[0];
  EXPECT_EQ(truth.name, "GOES 16");
  EXPECT_TRUE(truth.whole);
  const PixelPosition label{truth.middle_x_px, truth.middle_y_px};
  const auto measured = test::centroid(frame.counts, label, 12);
  record(std::hypot(measured.x_px - label.x_px, measured.y_px - label.y_px), 1);
  EXPECT_NEAR(measured.x_px, label.x_px, tolerance_px);
  EXPECT_NEAR(measured.y_px, label.y_px, tolerance_px);
  EXPECT_NEAR(truth.rendered_x_px, label.x_px, tolerance_px);
}

TEST(Registration, AStreakOfHundredsOfPixels) {
  // The ISS crosses the field of a telescope aboard GOES 16 that keeps its attitude to the stars.
  test::Stage stage(
      scenario(
          "{name: chaser, platform: \"41866\", camera: raven, pointing: "
          "{target: \"25544\", tracking: sidereal}, exposure_s: 20, cadence_s: 30, "
          "effects: {earth_occultation: off, earth_disc: off, limb_air: off, limb_airglow: off, "
          "shadow: off}}",
          "[{catalogue: objects.tle, radius_m: 20}]"),
      "ra_deg,dec_deg,mag_v\n0,-80,6\n", elements);
  const auto frame = stage.frame();
  ASSERT_EQ(frame.truths.size(), 1u);
  const auto& truth = frame.truths[0];
  EXPECT_TRUE(truth.whole);
  const double length =
      std::hypot(truth.end_x_px - truth.start_x_px, truth.end_y_px - truth.start_y_px);
  EXPECT_GT(length, 200);
  const auto measured =
      test::centroid(frame.counts, {truth.rendered_x_px, truth.rendered_y_px}, length);
  record(std::hypot(measured.x_px - truth.rendered_x_px, measured.y_px - truth.rendered_y_px), 1);
  EXPECT_NEAR(measured.x_px, truth.rendered_x_px, tolerance_px);
  EXPECT_NEAR(measured.y_px, truth.rendered_y_px, tolerance_px);
  // An even motion's centroid is its middle, but for the path's bend and changing brightness.
  EXPECT_NEAR(truth.rendered_x_px, truth.middle_x_px, 0.5);
  EXPECT_NEAR(truth.rendered_y_px, truth.middle_y_px, 0.5);
}

}  // namespace
}  // namespace dmise
