#include <algorithm>

#include "tests/pipeline/harness.h"

// Cameras that see much of the night sky and not a single object.
namespace dmise {
namespace {

/// Without objects, the sky's 60,000 stars to V = 9 above the horizon: one for every 13 pixels.
std::string night_fisheye(int frames) {
  return "simulation: {start: 2018-01-21T05:00:00Z, duration_s: " + std::to_string(20 * frames) +
         ", tick_s: 10}\n"
         "objects: []\n"
         "stars: {catalogue: kstars}\n"
         "sensors:\n"
         "  - name: fish\n"
         "    site: atlanta\n"
         "    camera:\n"
         "      optics: {projection: equidistant, columns: 1024, rows: 1024, pixel_pitch_m: 9e-6,"
         " field_of_view_deg: 180, aperture_m: 1e-3, psf_fwhm_px: 1.5, transmission: 0.8}\n"
         "      detector: {quantum_efficiency: 0.8, dark_e_per_s: 0.05, read_noise_e: 5,"
         " full_well_e: 50000, gain_e_per_dn: 1, bias_dn: 100, adc_bits: 16}\n"
         "      band: {name: V, centre_m: 0.55e-6, width_m: 0.09e-6}\n"
         "    pointing: zenith\n"
         "    exposure_s: 10\n"
         "    cadence_s: 20\n"
         "    sky: dark\n";
}

struct Seen {
  std::size_t detections = 0;
  std::uint32_t max_stars = 0;  // in a frame
};

Seen seen_in(const std::string& scenario, int frames) {
  test::Stage stage(scenario);
  Seen seen;
  for (int frame = 1; frame <= frames; ++frame) {
    const auto products = stage.frame(std::uint32_t(frame));
    seen.detections += products.detections.size();
    seen.max_stars = std::max(seen.max_stars, products.report.stars_rendered);
  }
  return seen;
}

TEST(NightFisheye, StarsAloneGiveAtMostOneDetectionIn30Frames) {
  const Seen seen = seen_in(night_fisheye(30), 30);
  EXPECT_GT(seen.max_stars, 50000u);
  EXPECT_LE(seen.detections, 1u);
}

// 328 hot pixels of the shipped camera stay where they are while stars move; in half a second few
// stars outshine them.
TEST(NightSwir, HotPixelsOfTheCameraAreNoObjects) {
  const Seen seen = seen_in(
      "simulation: {start: 2018-01-21T02:00:00Z, duration_s: 40, tick_s: 1, seed: 3}\n"
      "objects: []\n"
      "stars: {catalogue: kstars}\n"
      "sensors: [{name: swir, site: atlanta, camera: omnissa-swir, pointing: zenith,"
      " exposure_s: 0.5, cadence_s: 2, sky: dark}]\n",
      20);
  EXPECT_GT(seen.max_stars, 10000u);
  EXPECT_LE(seen.detections, 1u);
}

}  // namespace
}  // namespace dmise
