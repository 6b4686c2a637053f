#include <cmath>
#include <numeric>

#include "core/detection/wcs.h"
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
  const auto second = stage.frame(2).counts.pixels, first = stage.frame(1).counts.pixels;
  EXPECT_NE(first, second);
  EXPECT_EQ(stage.frame(2).counts.pixels, second);
  const auto& config = stage.scenario.sensors[0];
  for (int n : {1, 2, 4}) {
    Threads threads(n);
    FramePipeline pipeline({.sensor = config,
                            .clock = make_clock(stage.scenario),
                            .seed = stage.scenario.seed,
                            .digest = "test",
                            .faintest_star_mag = 15,
                            .detect = false},
                           stage.stars, threads);
    EXPECT_EQ(pipeline.run(frame_times(config, 1), stage.world).counts.pixels, first) << n;
    EXPECT_EQ(pipeline.run(frame_times(config, 2), stage.world).counts.pixels, second) << n;
  }
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

}  // namespace
}  // namespace dmise
