#include <cmath>

#include "core/base/units.h"
#include "core/photometry/magnitude.h"
#include "core/sky/places/sun_moon.h"
#include "tests/pipeline/harness.h"
#include "tests/support/projections.h"

// Rows of "Geometry and light" of the list of hard cases that take a whole frame.
namespace dmise::test {
namespace {

const Vec<Gcrs> eye_m{4.2e7, 1e6, 2e6};

std::string place(const Vec<Gcrs>& r) {
  char text[128];
  std::snprintf(text, sizeof text, "motion: {fixed: {gcrs_m: [%.6f, %.6f, %.6f]}}", r.x, r.y, r.z);
  return text;
}

/// An object among those of a scenario, with further keys.
std::string object(const std::string& name, const Vec<Gcrs>& r, const std::string& more) {
  return "  - name: " + name + "\n    " + place(r) + "\n" + more;
}

/// A camera that stands in space; no noise and no sky.
std::string scenario(const std::string& objects, const std::string& pointing,
                     const std::string& optics) {
  return "simulation: {start: 2018-01-21T00:15:00Z, duration_s: 10, tick_s: 5}\nobjects:\n" +
         object("platform", eye_m, "") + objects +
         "sensors:\n  - name: eye\n    platform: platform\n    pointing: " + pointing +
         "\n    exposure_s: 0.5\n    cadence_s: 5\n    sky: space\n    effects: {sky: off, "
         "photon_noise: off, read_noise: off, dark_current: off, quantisation: off, "
         "annual_aberration: off, sun_disc: off, moon_disc: off, earth_disc: off}\n    camera:\n   "
         "   optics: " +
         optics +
         "\n      detector: {full_well_e: 1.0e+9, gain_e_per_dn: 1, adc_bits: 16}\n      band: "
         "{name: V, centre_m: 0.55e-6, width_m: 0.1e-6}\n";
}

const std::string wide =
    "{columns: 128, rows: 128, pixel_pitch_m: 1.0e-5, focal_length_m: 0.1, aperture_m: 0.02}";

const Truth& truth_of(const FrameProducts& frame, const std::string& name) {
  for (const auto& truth : frame.truths)
    if (truth.name == name) return truth;
  throw std::runtime_error("no truth of " + name);
}

double total(const CountImage& counts) {
  double sum = 0;
  for (const auto c : counts.pixels) sum += c;
  return sum;
}

double expected_e(const FrameProducts& frame, const std::string& name) {
  const auto& truth = truth_of(frame, name);
  return frame.header.exposure_s *
         light_of_magnitude(truth.true_magnitude - frame.header.zero_point_mag) * truth.sunlit;
}

/// Away from the Sun, so that what lies there is lit from the front.
Vec<Gcrs> away_from_sun(const Stage& stage) { return -unit(stage.states.environment({0}).sun_m); }

TEST(HardLight, TwoObjectsInOnePixelAddTheirLightAndKeepTheirLabels) {
  Stage any(scenario(object("x", eye_m * 1.01, "    radius_m: 0.01\n"), "zenith", wide));
  const Vec<Gcrs> line = away_from_sun(any);
  const std::string a = object("near", eye_m + line * 2e4, "    radius_m: 0.02\n");
  const std::string b = object("far", eye_m + line * 4e4, "    radius_m: 0.03\n");
  Stage both(scenario(a + b, "{target: near}", wide)), one(scenario(a, "{target: near}", wide)),
      other(scenario(b, "{target: far}", wide));
  const auto all = both.frame(), first = one.frame(), second = other.frame();
  for (const std::string name : {"near", "far"}) {
    const auto& alone = truth_of(name == "near" ? first : second, name);
    const auto& together = truth_of(all, name);
    EXPECT_NEAR(together.rendered_signal_e / alone.rendered_signal_e, 1.0, 1e-6) << name;
    EXPECT_NEAR(together.rendered_x_px, alone.rendered_x_px, 1e-3) << name;
    EXPECT_NEAR(together.rendered_y_px, alone.rendered_y_px, 1e-3) << name;
  }
  EXPECT_NEAR(truth_of(all, "near").true_range_m, 2e4, 0.1);
  EXPECT_NEAR(truth_of(all, "far").true_range_m, 4e4, 0.1);
  EXPECT_GT(total(first.counts), 1000.0);
  EXPECT_NEAR(total(all.counts), total(first.counts) + total(second.counts), 40.0);  // rounding
}

// But for their discs, which are off here: an object before the Moon is as before the empty sky,
// and one before the Sun shows its dark side.
TEST(HardLight, AnObjectBeforeTheMoonKeepsItsLightAndBeforeTheSunIsDark) {
  Stage any(scenario(object("x", eye_m * 1.01, "    radius_m: 0.01\n"), "zenith", wide));
  const auto& window = any.states.environment({0});
  for (const bool moon : {true, false}) {
    const Vec<Gcrs> line = unit((moon ? window.moon_m : window.sun_m) - eye_m);
    Stage stage(scenario(object("passer", eye_m + line * 2e4, "    radius_m: 0.05\n"),
                         "{target: passer}", wide));
    const auto frame = stage.frame();
    const auto& truth = truth_of(frame, "passer");
    EXPECT_NEAR(truth.middle_x_px, 63.5, 0.02);
    EXPECT_NEAR(truth.middle_y_px, 63.5, 0.02);
    if (moon) {
      EXPECT_NEAR(truth.rendered_signal_e / expected_e(frame, "passer"), 1.0, 1e-3);
      EXPECT_NEAR(total(frame.counts), truth.rendered_signal_e,
                  0.02 * truth.rendered_signal_e + 40);
    } else {
      EXPECT_LT(truth.rendered_signal_e, 1.0);
      EXPECT_GE(truth.rendered_signal_e, 0.0);
      EXPECT_NEAR(truth.phase_angle_rad, pi, 1e-4);
    }
  }
}

TEST(HardLight, AResolvedObjectInAFisheyeGivesItsUnresolvedFlux) {
  Stage any(scenario(object("x", eye_m * 1.01, "    radius_m: 0.01\n"), "zenith", wide));
  const Vec<Gcrs> line = away_from_sun(any);
  const auto [ra, dec] = to_spherical(line);
  char pointing[128];  // 40 deg beside it
  std::snprintf(pointing, sizeof pointing, "{ra_deg: %.6f, dec_deg: %.6f}", ra / deg,
                dec / deg + 40 - (dec > 0 ? 80 : 0));
  for (const auto& [projection, yaml, fields_to_deg, widest_deg] : test::every_projection) {
    if (projection == "gnomonic") continue;
    Stage stage(scenario(
        object("box", eye_m + line * 1e3,
               "    attitude: {inertial: {gcrs_from_body: [0.8, 0.2, -0.4, 0.4]}}\n    geometry: "
               "{model: box, size_m: [2, 1, 1.5], material: white-paint}\n"),
        pointing,
        "{columns: 2048, rows: 2048, pixel_pitch_m: 1.0e-5, field_of_view_deg: 100, aperture_m: "
        "0.0005, projection: " +
            yaml + "}"));
    const auto frame = stage.frame();
    const auto& truth = truth_of(frame, "box");
    EXPECT_TRUE(truth.resolved) << projection;
    EXPECT_NEAR(truth.rendered_signal_e / expected_e(frame, "box"), 1.0, 5e-3) << projection;
  }
}

// A ball of 2.9 deg radius whose middle lies 2 deg from the boresight of a field of 0.7 deg.
TEST(HardLight, AnObjectWhoseRimReachesIntoTheFrameIsDrawn) {
  Stage any(scenario(object("x", eye_m * 1.01, "    radius_m: 0.01\n"), "zenith", wide));
  const Vec<Gcrs> line = away_from_sun(any);
  const auto [ra, dec] = to_spherical(line);
  char pointing[128];
  std::snprintf(pointing, sizeof pointing, "{ra_deg: %.6f, dec_deg: %.6f}", ra / deg,
                dec / deg + (dec > 0 ? -2.0 : 2.0));
  Stage stage(scenario(object("ball", eye_m + line * 2e4,
                              "    attitude: nadir\n    geometry: {model: sphere, radius_m: "
                              "1000, facets: 5000, material: grey}\n"),
                       pointing, wide));
  const auto frame = stage.frame();  // it covers the whole field
  const auto& truth = truth_of(frame, "ball");
  EXPECT_TRUE(truth.resolved);
  EXPECT_TRUE(truth.in_frame);
  EXPECT_GT(frame.counts.at(64, 64), 0);
}

}  // namespace
}  // namespace dmise::test
