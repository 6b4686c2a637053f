#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "core/photometry/magnitude.h"
#include "core/sim/state.h"
#include "tests/pipeline/harness.h"

namespace dmise::test {
namespace {

/// A camera aboard `eye` that looks at `target`; both near a chief, or one of them it.
std::string near_scenario(const std::string& objects, const std::string& optics) {
  return R"(
simulation: {start: 2018-01-21T00:15:00Z, duration_s: 20, tick_s: 5, seed: 1}
objects:
  - name: target
    motion: {two_body: {semi_major_axis_m: 7178137, eccentricity: 0.001, inclination_deg: 98.6, raan_deg: 0, true_anomaly_deg: 0}}
)" + objects +
         R"(
sensors:
  - name: eye
    platform: eye
    pointing: {target: target}
    exposure_s: 0.01
    cadence_s: 10
    sky: space
    effects: {sky: off, photon_noise: off, read_noise: off, dark_current: off}
    camera:
      optics: )" +
         optics + R"(
      detector: {full_well_e: 1.0e+9, gain_e_per_dn: 10, adc_bits: 16}
      band: {name: V, centre_m: 0.55e-6, width_m: 0.1e-6}
)";
}

const Truth& truth_of(const FrameProducts& frame, const std::string& name) {
  return *std::ranges::find(frame.truths, name, &Truth::name);
}

// Another object 1 % of the range beside the target is 1 % of the focal length beside it, from half
// a metre to 100 km.
TEST(ProximityFrames, PlacesArePixelsFromHalfAMetreToAHundredKilometres) {
  for (const double range_m : {0.5, 20.0, 3e3, 1e5}) {
    const std::string range = std::to_string(range_m);
    Stage stage(near_scenario(
        "    radius_m: 0.0001\n"
        "  - {name: beside, radius_m: 0.0001, motion: {proximity: {of: target, hold_rtn_m: [" +
            std::to_string(0.006 * range_m) + ", 0, " + std::to_string(0.008 * range_m) +
            "]}}}\n  - {name: eye, motion: {proximity: {of: target, hold_rtn_m: [0, -" + range +
            ", 0]}}}\n",
        "{columns: 512, rows: 512, pixel_pitch_m: 1.0e-5, focal_length_m: 0.1, aperture_m: 0.01}"));
    const auto frame = stage.frame(2);
    const Truth &target = truth_of(frame, "target"), &beside = truth_of(frame, "beside");
    EXPECT_NEAR(std::hypot(beside.middle_x_px - target.middle_x_px,
                           beside.middle_y_px - target.middle_y_px),
                100.0, 0.05)
        << range_m;
    EXPECT_NEAR(target.true_range_m / range_m, 1, 1e-5) << range_m;
  }
}

/// Light of a convex, diffuse box of grey at `eye_m` over that of the sum of its facets in parallel
/// lines at the distance of its centre: cos i cos r / d^2 over its faces, from its centre.
double near_over_far(const std::array<double, 3>& size_m, const Vec<Body>& sun,
                     const Vec<Body>& eye_m) {
  constexpr int parts = 60;
  double near = 0.0, far = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      std::array<double, 3> n{};
      n[axis] = side;
      const Vec<Body> normal{n[0], n[1], n[2]};
      const std::size_t b = (axis + 1) % 3, c = (axis + 2) % 3;
      const double patch_m2 = size_m[b] * size_m[c] / (parts * parts);
      const double lit = std::max(0.0, dot(normal, sun));
      far +=
          lit * std::max(0.0, dot(normal, unit(eye_m))) / dot(eye_m, eye_m) * size_m[b] * size_m[c];
      for (int k = 0; k < parts * parts; ++k) {
        std::array<double, 3> p{};
        p[axis] = side * size_m[axis] / 2;
        p[b] = size_m[b] * ((k % parts + 0.5) / parts - 0.5);
        p[c] = size_m[c] * ((k / parts + 0.5) / parts - 0.5);
        const Vec<Body> line = eye_m - Vec<Body>{p[0], p[1], p[2]};
        near += lit * std::max(0.0, dot(normal, unit(line))) / dot(line, line) * patch_m2;
      }
    }
  return near / far;
}

// From 20 m a satellite of two metres fills the frame. Its light is the sum of its facets, each
// seen from where the camera is: perspective changes it by some 10 % of that in parallel lines.
TEST(ProximityFrames, ACloseUpHasTheLightOfTheFacets) {
  const std::array<double, 3> size_m{1.5, 1.2, 1.0};
  double greatest = 0.0;
  for (const std::string place : {"[0, -20, 0]", "[-20, 0, 0]", "[0, 20, 3]", "[3, 4, -20]"}) {
    Stage stage(near_scenario(
        "    attitude: {tumbling: {inertia_kg_m2: [1, 2, 2.5], rate_deg_per_s: [1, 2, 1]}}\n"
        "    geometry: {model: box, size_m: [1.5, 1.2, 1], material: grey}\n"
        "  - {name: eye, motion: {proximity: {of: target, hold_rtn_m: " +
            place + "}}}\n",
        "{columns: 256, rows: 256, pixel_pitch_m: 1.0e-5, focal_length_m: 0.02, aperture_m: "
        "0.001, psf_fwhm_px: 1.5}"));
    const auto frame = stage.frame(2);
    const Truth& truth = truth_of(frame, "target");
    const SimTime middle = frame_times(stage.scenario.sensors[0], 2).middle;
    const auto index = [&](const std::string& name) {
      return object_index(stage.states.roster(), name, "test");
    };
    const auto body_from_gcrs = stage.states.gcrs_from_body(index("target"), middle)->inverse();
    const Vec<Gcrs> target_m = stage.states.motion(index("target"), middle).position_m;
    const double ratio = near_over_far(
        size_m, unit(body_from_gcrs * (stage.states.environment(middle).sun_m - target_m)),
        body_from_gcrs * (stage.states.motion(index("eye"), middle).position_m - target_m));
    const double parallel_e =
        frame.header.exposure_s * truth.sunlit *
        light_of_magnitude(truth.true_magnitude - frame.header.zero_point_mag);
    EXPECT_TRUE(truth.resolved);
    EXPECT_NEAR(truth.rendered_signal_e / parallel_e, ratio, 5e-3) << place;
    greatest = std::max(greatest, std::abs(ratio - 1));
  }
  EXPECT_GT(greatest, 0.02);
}

}  // namespace
}  // namespace dmise::test
