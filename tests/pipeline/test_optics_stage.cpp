#include <cmath>
#include <numeric>

#include "core/image/fits_cards.h"
#include "core/wcs/wcs.h"
#include "sensors/scene/optics_stage.h"
#include "tests/pipeline/harness.h"

// Whole frames through each way of blurring.
namespace dmise {
namespace {

const std::string quiet =
    "effects: {sky: off, photon_noise: off, dark_current: off, read_noise: off, full_well: off,"
    " quantisation: off, earth_occultation: off, extinction: off}\n";

const std::string detector =
    "detector: {full_well_e: 1.0e+6, gain_e_per_dn: 1}, band: {centre_m: 0.55e-6, width_m: "
    "0.1e-6}}\n";

/// One sensor of 160 x 120 px and 10 arcsec a pixel with these optics.
std::string scenario(const std::string& optics, const std::string& sensor = "exposure_s: 5") {
  return "simulation: {start: 2018-01-21T02:00:00Z, duration_s: 30, tick_s: 5}\nobjects: []\n"
         "stars: {catalogue: stars.csv, faintest_mag: 15}\n" +
         quiet +
         "sensors:\n  - {name: s, site: atlanta, pointing: {ra_deg: 60, dec_deg: 34}, cadence_s: "
         "10, " +
         sensor + ", camera: {optics: {columns: 160, rows: 120, " + optics + "}, " + detector +
         "    }\n";
}

const std::string coarse = "pixel_pitch_m: 5.0e-6, focal_length_m: 0.103, aperture_m: 0.05";
const std::string fine = "pixel_pitch_m: 4.0e-6, focal_length_m: 3, aperture_m: 0.3";

std::string stars(double step_deg, double mag) {
  std::string csv = "ra_deg,dec_deg,mag_v,bv,parallax_mas,pm_ra_mas_per_yr,pm_dec_mas_per_yr\n";
  for (int i = -2; i <= 2; ++i)
    for (int j = -2; j <= 2; ++j)
      csv += std::to_string(60 + i * step_deg / std::cos(34 / 57.2957795)) + "," +
             std::to_string(34 + j * step_deg) + "," + std::to_string(mag) + ",0.5,0,0,0\n";
  return csv;
}

double sum(const CountImage& counts) {
  return std::accumulate(counts.pixels.begin(), counts.pixels.end(), 0.0);
}

TEST(OpticsStage, StarsRegisterOnEveryPath) {
  for (const char* method : {"deposit", "direct", "transform"}) {
    test::Stage stage(scenario(coarse + ", psf_fwhm_px: 2.2, method: " + method), stars(0.05, 7));
    const auto frame = stage.frame();
    int count = 0;
    for (std::size_t i = 0; i < stage.stars->stars.size(); ++i) {
      const auto& s = stage.stars->stars;
      const auto at = wcs_pixel(frame.header.wcs, from_spherical<Gcrs>(s.ra_rad[i], s.dec_rad[i]));
      if (!at || at->x_px < 9 || at->y_px < 9 || at->x_px > 150 || at->y_px > 110) continue;
      const auto seen = test::centroid(frame.counts, *at, 8);
      EXPECT_NEAR(seen.x_px, at->x_px, 0.01) << method;
      EXPECT_NEAR(seen.y_px, at->y_px, 0.01) << method;
      ++count;
    }
    EXPECT_GT(count, 10) << method;
  }
}

TEST(OpticsStage, TheThreeWaysGiveOneFrame) {
  std::vector<CountImage> frames;
  for (const char* method : {"deposit", "direct", "transform"}) {
    test::Stage stage(scenario(coarse + ", psf_fwhm_px: 2.2, method: " + method), stars(0.05, 7));
    frames.push_back(stage.frame().counts);
  }
  const int peak = *std::max_element(frames[0].pixels.begin(), frames[0].pixels.end());
  ASSERT_GT(peak, 1000);
  for (int k : {1, 2})
    for (std::size_t i = 0; i < frames[0].pixels.size(); ++i)
      ASSERT_NEAR(frames[std::size_t(k)].pixels[i], frames[0].pixels[i], 1 + 1e-4 * peak);
}

TEST(OpticsStage, AFrameOfFrozenTurbulenceIsMadeAgainByItselfAndByAnyThreads) {
  test::Stage stage(scenario(fine + ", psf: diffraction",
                             "exposure_s: 0.005, seeing: {r0_m: 0.08, wind_m_per_s: 10}"),
                    stars(0.003, 3));
  test::expect_same_by_threads(stage, {1, 2, 4});
}

TEST(OpticsStage, TheCornersAreDarkerByTheVignetting) {
  const std::string corner = "ra_deg,dec_deg,mag_v,bv\n60.2,34.1,7,0.5\n";
  test::Stage open(scenario(coarse), corner);
  const auto plain = open.frame();
  test::Stage shut(scenario(coarse + ", vignetting: {corner: 0.5}"), corner);
  const auto dimmed = shut.frame();
  ASSERT_EQ(plain.stars.size(), 1u);
  const double r = std::hypot(plain.stars[0].x_px - 79.5, plain.stars[0].y_px - 59.5) / 100.0;
  ASSERT_GT(r, 0.3);
  EXPECT_NEAR(sum(dimmed.counts) / sum(plain.counts), 1 - 0.5 * r * r, 2e-3);
  EXPECT_NEAR(dimmed.stars[0].signal_e / plain.stars[0].signal_e, 1 - 0.5 * r * r, 2e-3);
}

TEST(OpticsStage, WhatCannotBeBlurredIsRefusedWhenTheScenarioIsRead) {
  // Speckle of 0.4 arcsec on pixels of 10.
  try {
    test::Stage stage(
        scenario("pixel_pitch_m: 50.0e-6, focal_length_m: 1.03, aperture_m: 0.4, psf: diffraction",
                 "exposure_s: 0.001, seeing: {r0_m: 0.01}"),
        stars(0.05, 7));
    FAIL();
  } catch (const ConfigError& e) {
    EXPECT_NE(std::string(e.what()).find("oversampling: the blur needs"), std::string::npos)
        << e.what();
  }
  EXPECT_THROW(test::Stage(scenario(coarse, "exposure_s: 1, seeing: {r0_m: 0.1}"), stars(0.05, 7)),
               ConfigError);
}

std::string refusal_of(const std::string& yaml) {
  try {
    test::Stage stage(yaml, stars(0.003, 3));
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "";
}

const std::string half_metre = "pixel_pitch_m: 5.0e-6, focal_length_m: 4, aperture_m: 0.4";

TEST(OpticsStage, WhatNoPupilCanSampleIsRefusedAtItsKeyWhenTheScenarioIsRead) {
  const std::string air = refusal_of(scenario(
      half_metre + ", psf: diffraction", "exposure_s: 1, seeing: {r0_m: 0.001, wind_m_per_s: 0}"));
  EXPECT_NE(air.find(".seeing.r0_m: turbulence too strong for the aperture"), std::string::npos)
      << air;
  EXPECT_NE(air.find("scenario.yaml:6:"), std::string::npos) << air;
  const std::string coma =
      refusal_of(scenario(half_metre + ", psf: diffraction, zernike_nm: {8: 1.0e+5}"));
  EXPECT_NE(coma.find(".optics.zernike_nm: a wavefront of"), std::string::npos) << coma;
  EXPECT_NE(coma.find("scenario.yaml:6:"), std::string::npos) << coma;
}

// Photometry of V 16 beside V -1.5, a ratio of 10^7: the bright one passes the transform by. The
// bound is that of the review of faint objects, 0.1 %.
TEST(OpticsStage, ABrightStarLeavesThePhotometryOfAFaintOneAlone) {
  SensorConfig sensor;
  sensor.name = "s";
  sensor.exposure_s = 5;
  sensor.camera.optics = {.focal_length_m = 3.0,
                          .aperture_m = 0.3,
                          .obscuration = 0.3,
                          .pixel_pitch_m = 4e-6,
                          .columns = 400,
                          .rows = 300};
  sensor.camera.optics.spread.model = PointSpread::Model::diffraction;
  sensor.camera.optics.spread.method = PointSpread::Method::transform;
  sensor.camera.optics.spread.support_px = 40;  // the bright one's own light ends before the other
  const double faint_e = 2e3, bright_e = faint_e * std::pow(10, 0.4 * 17.5);
  const auto at = [](double x, double y, double e) { return Arc{{x, y}, {x, y}, {x, y}, e}; };
  const Arc faint = at(300.3, 200.6, faint_e), bright = at(80.4, 70.1, bright_e);
  // Light in an aperture around the faint one.
  const auto light_of = [&](std::vector<Arc> arcs, double limit_e) {
    Threads one(1);
    OpticsStage stage(sensor, 1, one);
    ExpectedElectronImage light(400, 300);
    stage.begin({.frame = 1, .start = {0}, .middle = sim_seconds(2.5), .end = sim_seconds(5)},
                limit_e);
    stage.add(arcs, light);
    stage.finish(light);
    double sum = 0;
    for (int y = 185; y <= 216; ++y)
      for (int x = 285; x <= 316; ++x) sum += light.at(x, y);
    return sum;
  };
  const double limit_e = 100;  // 10 times a noise of 10 electrons
  const double alone = light_of({faint}, limit_e);
  EXPECT_GT(alone, 0.8 * faint_e);
  EXPECT_NEAR(light_of({faint, bright}, limit_e) / alone, 1.0, 1e-3);
  // What it would be without the way around: the threshold is what keeps it.
  EXPECT_GT(std::abs(light_of({faint, bright}, 1e9) / alone - 1.0), 1e-3);
}

// What `check` passes runs: a disc of 200 px, a seeing of 380 px.
TEST(OpticsStage, BlursOfHundredsOfPixelsMakeFrames) {
  test::Stage defocused(scenario(half_metre + ", psf: diffraction, defocus_m: 0.01"),
                        stars(0.003, 3));
  EXPECT_NEAR(defocused.frame().header.psf_fwhm_px, 200, 2);
  EXPECT_NO_THROW(as_in_file(defocused.frame().header));
  test::Stage turbulent(scenario(half_metre + ", psf: diffraction",
                                 "exposure_s: 5, seeing: {r0_m: 0.001, wind_m_per_s: 10}"),
                        stars(0.003, 3));
  const FrameHeader header = turbulent.frame().header;
  EXPECT_NEAR(header.psf_fwhm_px, 383, 8);
  EXPECT_NO_THROW(as_in_file(header));
}

}  // namespace
}  // namespace dmise
