#include "core/photometry/magnitude.h"
#include "tests/pipeline/wiring.h"

namespace dmise {
namespace {

// A sphere on a geosynchronous orbit enters the penumbra while a camera that stands in space looks
// for 60 s: 0.55 of the Sun is left at the end, and the light lies nearer to the start. Reference:
// rays to the Sun's disc past the ellipsoid, ERFA's Sun, by tests/reference/wiring.py.
TEST(Penumbra, TheLightOfASphereLiesWhereItIsLit) {
  const std::string objects =
      "objects:\n"
      "  - name: eye\n    motion: {fixed: {gcrs_m: [-1.0e+7, 0, 2.0e+7]}}\n"
      "  - name: sphere\n    motion: {two_body: {semi_major_axis_m: 42164000, eccentricity: 0, "
      "inclination_deg: 0, raan_deg: 0, true_anomaly_deg: 170.19211}}\n    radius_m: 30\n";
  test::Stage stage(test::scenario(
      "2018-03-20T00:00:00Z", 60, "platform: eye", test::camera(64, 64, 0.0145),
      "{ra_deg: 167.33729, dec_deg: -31.72577}", 60, 60,
      ", sky: space, effects: {" + test::noiseless + ", light_time: off, diurnal_aberration: off}",
      "", objects));
  const auto frame = stage.frame();
  ASSERT_EQ(frame.truths.size(), 1u);
  const auto& truth = frame.truths[0];
  const PixelPosition start{truth.start_x_px, truth.start_y_px};
  const PixelPosition path{truth.end_x_px - start.x_px, truth.end_y_px - start.y_px};
  const double length_px = std::hypot(path.x_px, path.y_px);
  EXPECT_NEAR(length_px, 7.0, 1.0);  // one arc
  const auto light = test::centroid(frame.counts, {31.5, 31.5}, 20);
  const auto along = [&](double x_px, double y_px) {
    return ((x_px - start.x_px) * path.x_px + (y_px - start.y_px) * path.y_px) /
           (length_px * length_px);
  };
  EXPECT_NEAR(along(light.x_px, light.y_px), 0.4517, 0.01);
  EXPECT_NEAR(along(truth.rendered_x_px, truth.rendered_y_px), 0.4517, 0.01);
  EXPECT_NEAR(truth.sunlit, 0.8124, 0.005);
  const double lit_e = frame.header.exposure_s *
                       light_of_magnitude(truth.true_magnitude - frame.header.zero_point_mag);
  EXPECT_NEAR(truth.rendered_signal_e / lit_e, 0.8124, 0.005);
}

}  // namespace
}  // namespace dmise
