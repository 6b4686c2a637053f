#include <algorithm>

#include "tests/pipeline/harness.h"

// A fisheye sees the whole night sky and not a single object.
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

TEST(NightFisheye, StarsAloneGiveAtMostOneDetectionIn30Frames) {
  constexpr int frames = 30;
  test::Stage stage(night_fisheye(frames));
  std::size_t detections = 0;
  std::uint32_t most_stars = 0;
  for (int frame = 1; frame <= frames; ++frame) {
    const auto products = stage.frame(std::uint32_t(frame));
    detections += products.detections.size();
    most_stars = std::max(most_stars, products.report.stars_rendered);
  }
  EXPECT_GT(most_stars, 50000u);
  EXPECT_LE(detections, 1u);
}

}  // namespace
}  // namespace dmise
