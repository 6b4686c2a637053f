#include <cmath>
#include <random>

#include "core/astrometry/solve_frame.h"
#include "core/base/units.h"
#include "core/image/fits_cards.h"
#include "tests/pipeline/wiring.h"

// What a frame's stars tell of a pointing that its header does not know.
namespace dmise {
namespace {

/// 6 stars a square degree around (30, 40) deg, each second twice as likely per magnitude.
std::string field() {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> even(0.0, 1.0);
  std::string csv = "ra_deg,dec_deg,mag_v,bv\n";
  for (int i = 0; i < 1200; ++i) {
    char line[96];
    std::snprintf(line, sizeof line, "%.8f,%.8f,%.3f,0.65\n", 30 + 18 * (even(random) - 0.5),
                  40 + 14 * (even(random) - 0.5), 9.0 + 1.45 * std::log2(even(random) + 0.03));
    csv += line;
  }
  return csv;
}

// The header is wrong by 2 deg and 5 deg of roll; the plate of the frame's stars, by which the
// detector reports, is within 0.03 px rms of where they were drawn.
TEST(SolvedPointing, OfACameraThatIsOffByTwoDegrees) {
  test::Stage stage(
      test::scenario(
          "2018-01-21T00:15:00Z", 20, "platform: platform",
          test::camera(
              1200, 1000, 0.1,
              "full_well_e: 1.0e+6, gain_e_per_dn: 20, read_noise_e: 8, adc_bits: 16, bias_dn: 100",
              ", aperture_m: 0.2, psf_fwhm_px: 2.2"),
          "{ra_deg: 30, dec_deg: 40}", 2, 5,
          ", sky: space, pointing_error: {bias_deg: [1.4, -1.4, 5], jitter_arcsec: 30}", "",
          "objects:\n  - name: platform\n    motion: {fixed: {gcrs_m: [42000000, "
          "1000000, 2000000]}}\n" +
              test::with_stars),
      field());
  const auto frame = stage.frame();
  const FrameSolution solved =
      solve_frame({frame.counts, as_in_file(frame.header)}, *stage.stars, {}, stage.threads);
  EXPECT_GE(solved.plate.fit.count, 100);
  const StarTable& table = stage.stars->stars;
  double of_solution = 0, of_header = 0, of_report = 0;
  int count = 0;
  for (std::size_t i = 0; i < table.v_mag.size(); ++i)
    for (const StarTruth& drawn : frame.stars) {
      if (drawn.id != table.id[i]) continue;
      const auto direction = from_spherical<Gcrs>(table.ra_rad[i], table.dec_rad[i]);
      const auto at = wcs_pixel(solved.wcs, direction),
                 told = wcs_pixel(frame.header.wcs, direction),
                 reported = wcs_pixel(frame.report.wcs, direction);
      ASSERT_TRUE(at && told && reported);
      of_report += std::pow(
          std::hypot(reported->x_px - drawn.middle.x_px, reported->y_px - drawn.middle.y_px), 2);
      of_solution +=
          std::pow(std::hypot(at->x_px - drawn.middle.x_px, at->y_px - drawn.middle.y_px), 2);
      of_header +=
          std::pow(std::hypot(told->x_px - drawn.middle.x_px, told->y_px - drawn.middle.y_px), 2);
      ++count;
    }
  ASSERT_GE(count, 100);
  EXPECT_LT(std::sqrt(of_solution / count), 0.03);
  EXPECT_LT(std::sqrt(of_report / count), 0.03);
  EXPECT_GE(frame.report.stars_found, 100u);
  EXPECT_GT(std::sqrt(of_header / count), 300.0);
}

}  // namespace
}  // namespace dmise
