#include "sensors/forecast/frame_forecast.h"
#include "tests/pipeline/shape_scenes.h"

// Tables of GalSim, made by tests/reference/range_defocus.py.
#include "tests/reference/range_defocus.inc"

// Frames of objects near enough to be out of focus.
namespace dmise::test {
namespace {

/// A telescope of 3 m with pixels of half lambda / D at 0.55 um.
std::string three_metres(const std::string& more, int side = 129) {
  const std::string n = std::to_string(side);
  return "{columns: " + n + ", rows: " + n +
         ", pixel_pitch_m: 4.125e-6, focal_length_m: 45, aperture_m: 3, " + more + "}";
}
constexpr double pixel_rad = 4.125e-6 / 45;

std::string ball(const Sight& sight, double range_m, double right_px = 0.0) {
  return shape_at("ball", sight, range_m, right_px * range_m * pixel_rad, 0,
                  "    radius_m: 1\n    albedo: 0.8\n");
}

struct BallScene {
  double range_m = 500e3;
  std::string optics = three_metres("psf: diffraction");
  std::string range_defocus = "0.3%";
  double right_px = 0.0, gain_e_per_dn = 20.0;
  std::string more = "";

  Stage stage(int threads = 1) const {
    const Sight sight = lit_sight();
    return Stage(text_of({.objects = ball(sight, range_m, right_px) +
                                     shape_at("middle", sight, 3e7, 0, 0, "    radius_m: 1e-3\n"),
                          .pointing = "{target: middle}",
                          .optics = optics,
                          .range_defocus = range_defocus,
                          .more = more,
                          .gain_e_per_dn = gain_e_per_dn}),
                 "", "", threads);
  }
};

double light_e(const FrameProducts& frame) {
  const auto& h = frame.header;
  return (total(frame.counts) - double(h.bias_dn) * double(frame.counts.pixels.size())) *
         h.gain_e_per_dn;
}

// Reference: GalSim's row through the middle of an object at 500 km; light from its magnitude.
TEST(RangeDefocusInFrame, OfATelescopeIsGalSims) {
  constexpr int side = 321, middle = side / 2;
  const auto frame =
      BallScene{.optics = three_metres("psf: diffraction", side), .gain_e_per_dn = 40}
          .stage()
          .frame();
  const Truth& truth = truth_named(frame, "ball");
  EXPECT_NEAR(truth.defocus_disc_px, 3.0 / 500e3 / pixel_rad, 0.2);
  EXPECT_NEAR(truth.rendered_signal_e, magnitude_e(frame, "ball"), 1e-3 * truth.rendered_signal_e);
  EXPECT_NEAR(light_e(frame), truth.rendered_signal_e, 1e-3 * truth.rendered_signal_e);
  const auto at = centroid(frame.counts, {middle, middle}, 100);
  EXPECT_NEAR(at.x_px, truth.middle_x_px, 0.01);
  EXPECT_NEAR(at.y_px, truth.middle_y_px, 0.01);
  EXPECT_NEAR(truth.rendered_x_px, truth.middle_x_px, 0.01);
  ASSERT_NEAR(truth.middle_x_px, middle, 0.01);
  double peak = 0.0;
  for (int i = 0; i <= 60; ++i) peak = std::max(peak, galsim_disc_500_km[i]);
  for (int i = 0; i <= 60; ++i)
    EXPECT_NEAR((frame.counts.at(middle + i, middle) - frame.header.bias_dn) *
                    frame.header.gain_e_per_dn / truth.rendered_signal_e,
                galsim_disc_500_km[i], 0.02 * peak)
        << i;
}

TEST(RangeDefocusInFrame, IsNoneWhenItIsOffOrTheObjectIsFar) {
  const auto off = BallScene{.range_defocus = "off", .gain_e_per_dn = 2000}.stage().frame();
  EXPECT_EQ(truth_named(off, "ball").defocus_disc_px, 0.0);
  const auto near = BallScene{.gain_e_per_dn = 2000}.stage().frame();
  EXPECT_GT(*std::ranges::max_element(off.counts.pixels),
            20 * *std::ranges::max_element(near.counts.pixels));
  const std::string small =
      "{columns: 64, rows: 64, pixel_pitch_m: 5.0e-6, focal_length_m: 0.2, aperture_m: 0.1}";
  const auto with = BallScene{.optics = small, .gain_e_per_dn = 1}.stage().frame();
  const auto without =
      BallScene{.optics = small, .range_defocus = "off", .gain_e_per_dn = 1}.stage().frame();
  EXPECT_EQ(with.counts.pixels, without.counts.pixels);
  EXPECT_EQ(truth_named(with, "ball").defocus_disc_px, 0.0);
}

// What lies beside the frame shines into it, and truth has it.
TEST(RangeDefocusInFrame, AnObjectBesideTheFrameIsInItByItsDisc) {
  const auto frame =
      BallScene{.optics = three_metres("psf_fwhm_px: 1.5"), .right_px = 84}.stage().frame();
  const Truth& truth = truth_named(frame, "ball");
  EXPECT_FALSE(truth.whole);
  EXPECT_TRUE(truth.in_frame);
  EXPECT_NEAR(light_e(frame), truth.rendered_signal_e, 1e-3 * truth.rendered_signal_e);
  // A segment of the disc of 65.45 px that is cut 19.5 px from its middle.
  const double h = 19.5 / (0.5 * 3.0 / 500e3 / pixel_rad);
  EXPECT_NEAR(truth.rendered_signal_e / magnitude_e(frame, "ball"),
              (std::acos(h) - h * std::sqrt(1 - h * h)) / pi, 2e-3);
}

TEST(RangeDefocusInFrame, IsTheSameByAnyNumberOfThreads) {
  for (const char* psf : {"psf: diffraction", "psf_fwhm_px: 1.5"}) {
    const BallScene scene{.optics = three_metres(psf)};
    EXPECT_EQ(scene.stage(1).frame().counts.pixels, scene.stage(4).frame().counts.pixels) << psf;
  }
}

// Focused on the object, the object is as sharp as it was without its range.
TEST(RangeDefocusInFrame, IsNoneAtTheDistanceOfFocus) {
  for (const std::string psf : {"psf: diffraction", "psf_fwhm_px: 1.5"}) {
    const auto sharp =
        BallScene{.optics = three_metres(psf), .range_defocus = "off", .gain_e_per_dn = 20000}
            .stage()
            .frame();
    const auto focused = BallScene{.optics = three_metres(psf + ", focus_distance_m: 500.0e+3"),
                                   .gain_e_per_dn = 20000}
                             .stage()
                             .frame();
    EXPECT_NEAR(truth_named(focused, "ball").defocus_disc_px, 0.0, 1e-6 + 0.1) << psf;
    EXPECT_NEAR(focused.counts.at(64, 64), sharp.counts.at(64, 64),
                2 + 0.01 * sharp.counts.at(64, 64))
        << psf;
  }
}

struct Spread {
  double sum = 0.0, xx = 0.0, yy = 0.0;
};
Spread spread_of(const FrameProducts& frame) {
  Spread s;
  double x = 0, y = 0;
  for (int v = 0; v < frame.counts.rows; ++v)
    for (int u = 0; u < frame.counts.columns; ++u) {
      const double e = frame.counts.at(u, v) - frame.header.bias_dn;
      s.sum += e, x += e * u, y += e * v, s.xx += e * u * u, s.yy += e * v * v;
    }
  s.xx = s.xx / s.sum - x / s.sum * (x / s.sum);
  s.yy = s.yy / s.sum - y / s.sum * (y / s.sum);
  return s;
}

// A plate of 60 x 30 pixels: its variances grow by those of the disc, d^2 / 16, and its light
// stays.
TEST(RangeDefocusInFrame, AResolvedShapeIsConvolvedWithTheDisc) {
  const Sight sight = lit_sight();
  constexpr double range_m = 500e3;
  const auto frame = [&](const std::string& level) {
    const std::string size =
        std::to_string(60 * range_m * pixel_rad) + ", " + std::to_string(30 * range_m * pixel_rad);
    return Stage(text_of(
                     {.objects = shape_at("plate", sight, range_m, 0, 0,
                                          facing(sight) + "    geometry: {model: plate, size_m: [" +
                                              size + "], front: white-paint, back: white-paint}\n"),
                      .pointing = "{target: plate}",
                      .optics = three_metres("psf_fwhm_px: 1.5", 161),
                      .range_defocus = level,
                      .gain_e_per_dn = 20000}))
        .frame();
  };
  const auto focused = frame("off"), near = frame("0.3%");
  EXPECT_TRUE(truth_named(near, "plate").resolved);
  const Spread a = spread_of(focused), b = spread_of(near);
  const double d_px = 3.0 / range_m / pixel_rad;
  EXPECT_NEAR(b.sum, a.sum, 1e-3 * a.sum);
  EXPECT_NEAR(b.xx - a.xx, d_px * d_px / 16, 0.01 * d_px * d_px / 16);
  EXPECT_NEAR(b.yy - a.yy, d_px * d_px / 16, 0.01 * d_px * d_px / 16);
}

/// Passes over the site's sky while the telescope follows the stars.
std::string passing(const std::string& accuracy) {
  return "simulation: {start: 2018-01-21T00:15:00Z, duration_s: 2, tick_s: 1, seed: 1}\nobjects:\n"
         "  - name: satellite\n    motion:\n      two_body: {position_m: [4418703, 3638930, "
         "3890179], velocity_m_per_s: [-5623.5, 1688.3, 4808.2]}\n    radius_m: 2\n" +
         accuracy +
         "effects: {sky: off, photon_noise: off, dark_current: off, read_noise: off, "
         "scintillation: "
         "off}\nsensors:\n  - name: eye\n    site: atlanta\n    pointing: {target: satellite, "
         "tracking: sidereal}\n    exposure_s: 0.02\n    cadence_s: 1\n    camera:\n      "
         "optics: " +
         three_metres("psf_fwhm_px: 1.5", 200) +
         "\n      detector: {full_well_e: 1.0e+9, gain_e_per_dn: 0.1}\n      band: {centre_m: "
         "0.55e-6, width_m: 0.1e-6}\n";
}

// Across its trail light is spread as chords of the disc are: variance d^2 / 16.
TEST(RangeDefocusInFrame, ATrailIsAsWideAsApertureOverRange) {
  const auto frame = Stage(passing("")).frame();
  const Truth& truth = frame.truths.at(0);
  const double d_px = 3.0 / truth.true_range_m / pixel_rad;
  EXPECT_NEAR(truth.defocus_disc_px, d_px, 0.01 * d_px);
  const double x = truth.end_x_px - truth.start_x_px, y = truth.end_y_px - truth.start_y_px;
  const double length_px = std::hypot(x, y);
  ASSERT_GT(length_px, 1000.0);
  double sum = 0, across2 = 0, left = 0, right = 0;
  for (int v = 0; v < 200; ++v)
    for (int u = 0; u < 200; ++u) {
      const double at = ((u - truth.middle_x_px) * y - (v - truth.middle_y_px) * x) / length_px;
      const double along = ((u - truth.middle_x_px) * x + (v - truth.middle_y_px) * y) / length_px;
      if (std::abs(along) > 40) continue;
      const double e = frame.counts.at(u, v) - frame.header.bias_dn;
      sum += e, across2 += e * at * at;
      (at < 0 ? left : right) += e;
    }
  ASSERT_GT(sum, 1000.0);
  const double blur_px2 = 1.5 * 1.5 / 5.545 + 1.0 / 12;
  EXPECT_NEAR(across2 / sum, d_px * d_px / 16 + blur_px2, 0.02 * d_px * d_px / 16);
  EXPECT_NEAR(left / right, 1.0, 0.02);
}

// A plan draws what is near out of focus, and pays for it; of what is far it takes no notice.
TEST(RangeDefocusInFrame, IsPlannedByTheRanges) {
  const auto near = Stage(passing("accuracy: standard\n")).frame();
  EXPECT_GT(near.plan.effects.level(RangeDefocus::facts), 0);
  EXPECT_TRUE(near.plan.error.within(near.plan.budget));
  EXPECT_GT(near.truths.at(0).defocus_disc_px, 10.0);
  const std::string small =
      "{columns: 64, rows: 64, pixel_pitch_m: 5.0e-6, focal_length_m: 0.2, aperture_m: 0.1}";
  const auto far = BallScene{.optics = small,
                             .range_defocus = "1%",
                             .gain_e_per_dn = 1,
                             .more = "accuracy: standard\n"}
                       .stage()
                       .frame();
  for (const PlannedEffect& effect : far.plan.planned)
    if (effect.facts == &RangeDefocus::facts) {
      EXPECT_EQ(effect.cost_s, 0.0);
      EXPECT_EQ(effect.error, ErrorBound{});
    }
}

// The limit falls by 2.5 log of the ratio of widths where the sky makes the noise.
TEST(RangeDefocusInFrame, TheLimitOfANearObjectIsOfItsWidth) {
  const Stage stage(passing(""));
  const SensorConfig& sensor = stage.scenario.sensors[0];
  const BlurByRange blur(sensor);
  EXPECT_NEAR(blur.disc_px(500e3), 3.0 / 500e3 / pixel_rad, 1e-9);
  EXPECT_EQ(blur.disc_px(1e12), 0.0);
  EXPECT_EQ(blur.sigma_px(1e12), blur_sigma_px(sensor));
  EXPECT_NEAR(blur.sigma_px(500e3), 0.25 * blur.disc_px(500e3), 0.05);
}

}  // namespace
}  // namespace dmise::test
