#include "tests/pipeline/shape_scenes.h"

namespace dmise::test {
namespace {

/// White, far and large; black, near and half as wide in the image; both before the camera.
std::string white_plate(const Sight& sight, double range_m = 2000) {
  const std::string side = std::to_string(range_m * 64e-5);  // 64 pixels
  return shape_at("far", sight, range_m, 0, 0,
                  facing(sight) + "    geometry: {model: plate, size_m: [" + side + ", " + side +
                      "], front: white-paint, back: white-paint}\n");
}
std::string black_plate(const Sight& sight, double range_m = 1000) {
  const std::string side = std::to_string(range_m * 32e-5);
  return shape_at("near", sight, range_m, 0, 0,
                  facing(sight) + "    geometry: {model: plate, size_m: [" + side + ", " + side +
                      "], front: dark, back: dark, materials: " + DMISE_SOURCE_DIR +
                      "/tests/pipeline/plain.yaml}\n");
}

const std::string sharp =
    "{columns: 128, rows: 128, pixel_pitch_m: 1.0e-5, focal_length_m: 1, aperture_m: 0.2, "
    "psf_fwhm_px: 0.4}";
const std::string blurred =
    "{columns: 128, rows: 128, pixel_pitch_m: 1.0e-5, focal_length_m: 1, aperture_m: 0.02, psf: "
    "diffraction}";

// The square of 32 x 32 pixels in the middle of one of 64 x 64 is black, whatever comes first in
// the list.
TEST(Occlusion, ANearPlateHidesAFarOneInWhateverOrderTheyAreListed) {
  const Sight sight = lit_sight();
  const auto frame = [&](const std::string& objects) {
    return Stage(text_of({.objects = objects,
                          .pointing = "{target: far}",
                          .optics = sharp,
                          .gain_e_per_dn = 100000}))
        .frame();
  };
  const auto alone = frame(white_plate(sight));
  const auto a = frame(white_plate(sight) + black_plate(sight));
  const auto b = frame(black_plate(sight) + white_plate(sight));
  EXPECT_EQ(a.counts.pixels, b.counts.pixels);
  ASSERT_EQ(a.truths.size(), 2u);
  EXPECT_EQ(a.truths[0].name, "far");  // as listed
  EXPECT_EQ(b.truths[0].name, "near");
  EXPECT_GT(alone.counts.at(64, 64), 1000);
  for (int y = 49; y < 79; ++y)
    for (int x = 49; x < 79; ++x) ASSERT_EQ(a.counts.at(x, y), 0) << x << " " << y;
  for (int i = 34; i < 94; ++i)
    for (const int edge : {36, 44, 84, 92}) {
      ASSERT_EQ(a.counts.at(edge, i), alone.counts.at(edge, i)) << edge << " " << i;
      ASSERT_EQ(a.counts.at(i, edge), alone.counts.at(i, edge)) << edge << " " << i;
    }
  EXPECT_NEAR(total(a.counts) / total(alone.counts), 0.75, 0.002);
  EXPECT_NEAR(truth_named(a, "far").rendered_signal_e / truth_named(alone, "far").rendered_signal_e,
              0.75, 0.002);
}

// White before black hides nothing of the white; the order is by range, not by brightness.
TEST(Occlusion, WhatIsFartherHidesNothing) {
  const Sight sight = lit_sight();
  const auto frame = [&](const std::string& objects) {
    return Stage(text_of({.objects = objects,
                          .pointing = "{target: far}",
                          .optics = sharp,
                          .gain_e_per_dn = 100000}))
        .frame();
  };
  const auto alone = frame(white_plate(sight, 500));
  EXPECT_EQ(frame(white_plate(sight, 500) + black_plate(sight)).counts.pixels, alone.counts.pixels);
  EXPECT_EQ(frame(black_plate(sight) + white_plate(sight, 500)).counts.pixels, alone.counts.pixels);
}

// A point without a shape behind the black plate, before it, and beside it.
TEST(Occlusion, APointBehindAPlateIsDarkAndOneBeforeItIsNot) {
  const Sight sight = lit_sight();
  for (const std::string& optics : {sharp, blurred}) {
    const auto signal_e = [&](double range_m, double aside_m, bool with_plate) {
      const std::string point =
          shape_at("point", sight, range_m, aside_m, 0, "    radius_m: 0.5\n");
      const auto frame = Stage(text_of({.objects = (with_plate ? black_plate(sight) : "") + point,
                                        .pointing = "{target: point}",
                                        .optics = optics}))
                             .frame();
      return truth_named(frame, "point").rendered_signal_e;
    };
    const double free_e = signal_e(50e3, 0, false);
    EXPECT_GT(free_e, 100.0);
    EXPECT_EQ(signal_e(50e3, 0, true), 0.0);
    EXPECT_NEAR(signal_e(50e3, 50e3 * 20e-5, true) / signal_e(50e3, 50e3 * 20e-5, false), 1.0,
                1e-6);
    EXPECT_NEAR(signal_e(900, 0, true) / signal_e(900, 0, false), 1.0, 1e-6);
  }
}

/// A catalogue of stars 20 px apart along a line, the middle one behind the plate.
std::string five_stars(const Sight& sight) {
  std::string stars = "ra_deg,dec_deg,mag_v,bv\n";
  for (int i = -2; i <= 2; ++i) {
    const auto [ra, dec] = to_spherical(unit(sight.line + sight.right * (i * 20e-5)));
    char line[96];
    std::snprintf(line, sizeof line, "%.9f,%.9f,0.0,0.6\n", ra / deg, dec / deg);
    stars += line;
  }
  return stars;
}

// Stars 20 px apart along a line: those behind the plate of 32 x 32 px are gone, with a blur summed
// directly and with one by transform.
TEST(Occlusion, StarsBehindAPlateAreDark) {
  const Sight sight = lit_sight();
  const std::string stars = five_stars(sight);
  for (const std::string& optics : {sharp, blurred}) {
    Stage stage(text_of({.objects = black_plate(sight),
                         .pointing = "{target: near}",
                         .optics = optics,
                         .effects = "sky: off, diurnal_aberration: off, light_deflection: off, ",
                         .more = "stars: {catalogue: stars.csv, faintest_mag: 9}\n",
                         .gain_e_per_dn = 1000}),
                stars);
    const auto frame = stage.frame();
    ASSERT_EQ(frame.stars.size(), 4u);
    for (const auto& star : frame.stars) {
      EXPECT_GT(std::abs(star.x_px - 63.5), 19.0);
      EXPECT_NEAR(star.signal_e / frame.stars[0].signal_e, 1.0, 1e-2);
    }
    const auto star_e = frame.stars[0].signal_e;
    EXPECT_GT(star_e, 1e4);
    EXPECT_LT(frame.counts.at(63, 63), 1e-6 * star_e);
    EXPECT_NEAR(1000 * total(frame.counts) / (4 * star_e), 1.0, 0.1);
  }
}

// With the effect off all five stars shine, each as the free ones do.
TEST(Occlusion, OffHidesNothing) {
  const Sight sight = lit_sight();
  const std::string stars = five_stars(sight);
  Stage stage(text_of({.objects = black_plate(sight),
                       .pointing = "{target: near}",
                       .optics = sharp,
                       .effects = "occlusion: off, sky: off, ",
                       .more = "stars: {catalogue: stars.csv, faintest_mag: 9}\n",
                       .gain_e_per_dn = 1000}),
              stars);
  const auto frame = stage.frame();
  ASSERT_EQ(frame.stars.size(), 5u);
  for (const auto& star : frame.stars)
    EXPECT_NEAR(star.signal_e / frame.stars[0].signal_e, 1.0, 1e-2);
}

// From orbit all of the sky is behind.
TEST(Occlusion, InOrbitTheSkyBehindAPlateIsDark) {
  const Sight sight = lit_sight();
  const auto frame =
      Stage(text_of({.objects = black_plate(sight),
                     .pointing = "{target: near}",
                     .optics = "{columns: 128, rows: 128, pixel_pitch_m: 1.0e-5, "
                               "focal_length_m: 1, aperture_m: 0.5, psf_fwhm_px: 0.4}",
                     .effects = "",
                     .gain_e_per_dn = 0.001}))
          .frame();
  EXPECT_GT(frame.counts.at(5, 5), 1000);
  for (int y = 49; y < 79; ++y)
    for (int x = 49; x < 79; ++x) ASSERT_EQ(frame.counts.at(x, y), 0) << x << " " << y;
  EXPECT_NEAR(total(frame.counts) / frame.counts.at(5, 5), 128 * 128 - 32 * 32, 60);
}

// On the ground zodiacal light and faint starlight come from behind; airglow and lamps do not.
TEST(Occlusion, OnTheGroundOnlyTheLightFromBeyondIsHidden) {
  const auto scenario = [](bool object, const std::string& effects) {
    return std::string(R"(
simulation: {start: 2018-01-21T05:15:00Z, duration_s: 10, tick_s: 2, seed: 1}
objects:
  - name: platform
    motion: {fixed: {latitude_deg: 0, longitude_deg: 100, height_m: 300000}}
)") +
           (object ? R"(  - name: target
    motion: {fixed: {latitude_deg: 33.777, longitude_deg: -84.398, height_m: 300000}}
    attitude: nadir
    geometry: {model: plate, size_m: [300, 300], front: dark, back: dark, materials: )" DMISE_SOURCE_DIR
                     R"(/tests/pipeline/plain.yaml}
)"
                   : "") +
           R"(sensors:
  - name: eye
    site: atlanta
    pointing: zenith
    exposure_s: 1
    cadence_s: 10
    sky: suburban
    effects: {)" +
           effects + R"(photon_noise: off, read_noise: off, dark_current: off}
    camera:
      optics: {columns: 128, rows: 128, pixel_pitch_m: 1.0e-5, focal_length_m: 0.5, aperture_m: 0.2, psf_fwhm_px: 1.5}
      detector: {full_well_e: 1.0e+9, gain_e_per_dn: 0.002, adc_bits: 16}
      band: {name: V, centre_m: 0.55e-6, width_m: 0.1e-6}
)";
  };
  const double sky = Stage(scenario(false, "")).frame().counts.at(64, 64);
  const double before = Stage(scenario(false, "zodiacal_light: off, faint_starlight: off, "))
                            .frame()
                            .counts.at(64, 64);
  const auto frame = Stage(scenario(true, "")).frame();
  ASSERT_TRUE(frame.truths.at(0).resolved);
  EXPECT_GT(before, 1000.0);
  EXPECT_GT(sky - before, 0.02 * sky);
  EXPECT_NEAR(frame.counts.at(64, 64), before, 0.005 * sky);
  EXPECT_NEAR(frame.counts.at(5, 5), sky, 0.01 * sky);
}

}  // namespace
}  // namespace dmise::test
