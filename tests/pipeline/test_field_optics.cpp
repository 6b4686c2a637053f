#include <cmath>
#include <numeric>

#include "core/image/fits_cards.h"
#include "core/optics/field_blur.h"
#include "core/optics/projection.h"
#include "sensors/scene/optics_stage.h"
#include "tests/pipeline/harness.h"

// Frames of cameras with tables over the field and a focus that drifts.
namespace dmise {
namespace {

const std::string quiet =
    "effects: {photon_noise: off, dark_current: off, read_noise: off, full_well: off,"
    " quantisation: off, earth_occultation: off, extinction: off, scintillation: off, ";

/// One sensor of 160 x 120 px; its middle looks to RA 60, Dec 34.
std::string scenario(const std::string& optics, const std::string& effects = "sky: off",
                     const std::string& more = "", int duration_s = 30) {
  return "simulation: {start: 2018-01-21T02:00:00Z, duration_s: " + std::to_string(duration_s) +
         ", tick_s: 5}\nobjects: []\nstars: {catalogue: stars.csv, faintest_mag: 15}\n" + quiet +
         effects + "}\n" + more +
         "sensors:\n  - {name: s, site: atlanta, pointing: {ra_deg: 60, dec_deg: 34}, cadence_s: "
         "10, exposure_s: 5, sky: 18, camera: {optics: {columns: 160, rows: 120, " +
         optics +
         "}, detector: {full_well_e: 1.0e+6, gain_e_per_dn: 1}, band: {centre_m: 0.55e-6, width_m: "
         "0.1e-6}}}\n";
}

const std::string coarse = "pixel_pitch_m: 5.0e-6, focal_length_m: 0.103, aperture_m: 0.05";
const std::string fine = "pixel_pitch_m: 2.75e-6, focal_length_m: 0.5, aperture_m: 0.1";

std::string stars(double step_deg, double mag, int reach = 2) {
  std::string csv = "ra_deg,dec_deg,mag_v,bv\n";
  for (int i = -reach; i <= reach; ++i)
    for (int j = -reach; j <= reach; ++j)
      csv += std::to_string(60 + i * step_deg / std::cos(34 / 57.2957795)) + "," +
             std::to_string(34 + j * step_deg) + "," + std::to_string(mag) + ",0.5\n";
  return csv;
}

// The table's profile, and 0 at its end: of a flat sky, less the pixels' solid angle.
TEST(FieldOptics, AFlatFrameHasTheVignettingOfTheTable) {
  const std::string table =
      ", vignetting: {radius_px: [0, 30, 60, 100], relative_illumination: [1, 0.9, 0.4, 0]}";
  test::Stage stage(scenario(coarse + table, "sky_grid: pixel, stars: off"), stars(0.05, 7));
  const auto frame = stage.frame();
  test::Stage open(scenario(coarse, "sky_grid: pixel, stars: off"), stars(0.05, 7));
  const auto flat = open.frame();
  const MonotoneCubic curve({0, 30, 60, 100}, {1, 0.9, 0.4, 0});
  const double bias = frame.header.bias_dn;
  for (int y = 0; y < 120; y += 7)
    for (int x = 0; x < 160; x += 9) {
      const double share = curve(std::hypot(x - 79.5, y - 59.5));
      const double open_dn = flat.counts.at(x, y) - bias;
      EXPECT_NEAR(frame.counts.at(x, y) - bias, share * open_dn, 0.5 + 1e-3 * open_dn);
    }
  EXPECT_EQ(frame.header.illumination, curve);
  EXPECT_TRUE(flat.header.illumination.empty());
}

TEST(FieldOptics, HeadersKeepTheTableAndTheDefocus) {
  test::Stage stage(
      scenario(coarse +
               ", focus_drift: {um_per_hour: 3600}, vignetting: {radius_deg: [0, 0.1, 0.3], "
               "relative_illumination: [1, 0.9, 0.25]}"),
      stars(0.05, 7));
  const auto frame = stage.frame(2);
  ASSERT_TRUE(frame.header.defocus_um);
  EXPECT_NEAR(*frame.header.defocus_um, 12.5, 1e-9);  // in the middle of 10 to 15 s
  const FrameHeader again = as_in_file(frame.header);
  EXPECT_EQ(again.illumination, frame.header.illumination);
  EXPECT_EQ(again.illumination_radius, FieldRadius::angle_deg);
  EXPECT_EQ(again.defocus_um, frame.header.defocus_um);
}

// The truth is the place of the chief ray; light is beside it by what docs/models/optics.md states.
TEST(FieldOptics, TruthIsWhereTheChiefRayIsAndComaPutsTheLightBesideIt) {
  const std::string coma =
      ", psf: diffraction, psf_field: {radius_px: [0, 100], zernike_nm: {8: [0, 60]}}";
  test::Stage stage(scenario(fine + coma, "sky: off, psf_field: 5x5"), stars(0.012, 8.5));
  const auto frame = stage.frame();
  const Optics& o = stage.scenario.sensors[0].camera.optics;
  int seen = 0;
  for (const auto& star : frame.stars) {
    if (star.x_px < 14 || star.x_px > 145 || star.y_px < 14 || star.y_px > 105) continue;
    const auto light = test::centroid(frame.counts, {star.x_px, star.y_px}, 13);
    const double dx = star.x_px - 79.5, dy = star.y_px - 59.5, r = std::hypot(dx, dy);
    const auto shift = centroid_of_field_px(o, {r / corner_px(o), std::atan2(dy, dx)});
    // Coma puts 0.05 px of the shift in light beyond 13 px.
    EXPECT_NEAR(light.x_px - star.x_px, shift[0], 0.05);
    EXPECT_NEAR(light.y_px - star.y_px, shift[1], 0.05);
    if (r > 50) {
      EXPECT_GT(std::hypot(shift[0], shift[1]), 0.3);
    }
    ++seen;
  }
  EXPECT_GT(seen, 8);
}

TEST(FieldOptics, AStarBesideTheFrameShinesIntoIt) {
  // 3.4 px right of the last column's middle.
  const double x_deg = (159 + 3.4 - 79.5) * 5e-6 / 0.103 * 57.2957795;
  const std::string wide =
      ", psf_field: {radius_px: [0, 80], fwhm_radial_px: [1.5, 8], "
      "fwhm_tangential_px: [1.5, 3]}";
  test::Stage stage(scenario(coarse + wide),
                    "ra_deg,dec_deg,mag_v,bv\n" +
                        std::to_string(60 - x_deg / std::cos(34 / 57.2957795)) + ",34,5,0.5\n" +
                        std::to_string(60 + x_deg / std::cos(34 / 57.2957795)) + ",34,5,0.5\n");
  const auto frame = stage.frame();
  double left = 0, right = 0;
  for (int y = 0; y < 120; ++y)
    for (int i = 0; i < 20; ++i)
      left += frame.counts.at(i, y), right += frame.counts.at(159 - i, y);
  EXPECT_GT(std::min(left, right), 1000.0);
}

TEST(FieldOptics, FramesAreTheSameByAnyNumberOfThreads) {
  test::Stage stage(
      scenario(coarse + ", focus_drift: {um_per_hour: 3600}, psf_field: {radius_px: [0, 100], "
                        "fwhm_radial_px: [2, 5], fwhm_tangential_px: [2, 3]}"),
      stars(0.05, 8));
  test::expect_same_by_threads(stage, {3});  // each with a focus of its own
}

TEST(FieldOptics, SwitchedOffTheBlurIsThatOfTheCentreAndInFocus) {
  const std::string varying =
      ", psf_field: {radius_px: [0, 100], fwhm_radial_px: [2.2, 6]}, "
      "focus_drift: {start_um: 60}";
  test::Stage off(scenario(coarse + varying, "sky: off, psf_field: off, focus_drift: off"),
                  stars(0.05, 7));
  test::Stage even(scenario(coarse + ", psf_fwhm_px: 2.2"), stars(0.05, 7));
  const auto a = off.frame(), b = even.frame();
  const int peak = *std::max_element(b.counts.pixels.begin(), b.counts.pixels.end());
  for (std::size_t i = 0; i < a.counts.pixels.size(); ++i)
    ASSERT_NEAR(a.counts.pixels[i], b.counts.pixels[i], 1 + 2e-4 * peak);
  EXPECT_FALSE(a.header.defocus_um);
}

// A drift of nothing is none: the same bytes.
TEST(FieldOptics, ADriftOfNothingLeavesTheBytes) {
  test::Stage none(scenario(coarse), stars(0.05, 7)),
      still(scenario(coarse + ", focus_drift: {start_um: 0, um_per_k: 3}"), stars(0.05, 7));
  EXPECT_EQ(none.frame().counts.pixels, still.frame().counts.pixels);
}

// The planner takes as many kernels as its budget asks for.
TEST(FieldOptics, APlanTakesFewerKernelsForLooserBudgets) {
  const auto level = [](const std::string& budget) {
    test::Stage stage(
        scenario(coarse + ", psf_field: {radius_px: [0, 100], fwhm_radial_px: [3, 3.6]}", "sky: on",
                 "accuracy: " + budget + "\n"),
        stars(0.05, 9));
    return stage.frame().plan.effects.level(FieldBlur::facts);
  };
  const int draft = level("draft"), reference = level("reference");
  EXPECT_EQ(reference, FieldBlur::facts.reference());
  EXPECT_LT(draft, reference);
}

}  // namespace
}  // namespace dmise
