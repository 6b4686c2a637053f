#include <gtest/gtest.h>

#include <cmath>

#include "core/photometry/magnitude.h"
#include "sensors/pipeline/throughput.h"
#include "tests/pipeline/harness.h"

namespace dmise::test {
namespace {

/// Two objects 20 km ahead of the camera's platform, which looks at the first; neither noise nor
/// sky.
std::string scenario(const std::string& target, const std::string& optics,
                     const std::string& attitude = "nadir") {
  return R"(
simulation: {start: 2018-01-21T00:15:00Z, duration_s: 20, tick_s: 5, seed: 1}
objects:
  - name: platform
    motion: {two_body: {semi_major_axis_m: 7178137, eccentricity: 0, inclination_deg: 98.6, raan_deg: 0, true_anomaly_deg: 0}}
  - name: target
    motion: {two_body: {semi_major_axis_m: 7178137, eccentricity: 0, inclination_deg: 98.6, raan_deg: 0, true_anomaly_deg: 0.16}}
    attitude: )" +
         attitude + "\n" + target + R"(
sensors:
  - name: eye
    platform: platform
    pointing: {target: target}
    exposure_s: 0.5
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

const std::string wide =
    "{columns: 256, rows: 256, pixel_pitch_m: 1.0e-5, focal_length_m: 0.1, aperture_m: 0.05}";
const std::string tele =
    "{columns: 256, rows: 256, pixel_pitch_m: 1.0e-5, focal_length_m: 10, aperture_m: 0.5}";

const Truth& target_of(const FrameProducts& frame) {
  for (const auto& truth : frame.truths)
    if (truth.name == "target") return truth;
  throw std::runtime_error("no target");
}

/// Electrons that the truth's magnitude stands for.
double expected_e(const FrameProducts& frame) {
  const auto& truth = target_of(frame);
  return frame.header.exposure_s *
         light_of_magnitude(truth.true_magnitude - frame.header.zero_point_mag) * truth.sunlit;
}

// The same sphere by its closed form and as a mesh.
TEST(Shapes, ASphereOfFacetsIsAsBrightAsTheDiffuseSphere) {
  for (const std::string radius : {"0.08", "1"}) {  // without and with a size of its own
    Stage facets(scenario(
        "    geometry: {model: sphere, radius_m: " + radius + ", facets: 5000, material: grey}",
        wide));
    Stage closed(scenario("    radius_m: " + radius + "\n    albedo: 0.2", wide));
    const auto a = facets.frame(), b = closed.frame();
    EXPECT_NEAR(target_of(a).rendered_signal_e / target_of(b).rendered_signal_e, 1.0, 5e-3);
    EXPECT_NEAR(target_of(a).true_magnitude, target_of(b).true_magnitude, 3e-3);
    EXPECT_EQ(target_of(a).resolved, radius == "1");
  }
}

TEST(Shapes, ResolvedAndUnresolvedGiveTheSameLight) {
  for (const std::string model : {"box-wing", "starlink-like", "cylinder"}) {
    Stage near(scenario("    geometry: {model: " + model + "}", tele));
    const auto frame = near.frame();
    const auto& truth = target_of(frame);
    EXPECT_TRUE(truth.resolved) << model;
    EXPECT_NEAR(truth.rendered_signal_e / expected_e(frame), 1.0, 5e-3) << model;
    EXPECT_NEAR(truth.rendered_x_px, truth.middle_x_px, 6.0) << model;
    Stage far(scenario("    geometry: {model: " + model + ", scale: 0.001}", wide));
    const auto point = far.frame();
    EXPECT_FALSE(target_of(point).resolved) << model;
    EXPECT_NEAR(target_of(point).rendered_signal_e / expected_e(point), 1.0, 1e-3) << model;
  }
}

// Spinning at 10 turns a minute an exposure of 0.5 s sees 30 deg of the light curve.
TEST(Shapes, ASpinningShapeShinesDifferentlyFromFrameToFrame) {
  Stage stage(scenario("    geometry: {model: box-wing, scale: 0.001}", wide,
                       "{spinning: {axis: [0.3, 1, 0], rate_rpm: 7}}"));
  const double first = target_of(stage.frame(1)).rendered_signal_e;
  const double second = target_of(stage.frame(2)).rendered_signal_e;
  EXPECT_GT(first, 0.0);
  EXPECT_GT(std::abs(first / second - 1.0), 0.02);
}

// A panel that turns once a second flashes for some 10 ms: far less than one of four snapshots of
// the exposure. Against the light at 20,000 instants.
TEST(Shapes, AGlintShorterThanASnapshotIsNotLost) {
  Stage stage(scenario(
      "    geometry: {model: plate, scale: 0.001, front: silicon-cell, back: silicon-cell}", wide,
      "{spinning: {axis: [0.1, 1, 0], rate_rpm: 60}}"));
  const auto& sensor = stage.scenario.sensors.at(0);
  const ObjectShapes shapes(stage.scenario.own_objects, sensor.camera.band);
  for (const std::uint32_t number : {1u, 2u}) {
    const FrameTimes times = frame_times(sensor, number);
    const View view(sensor, times, stage.world);
    const std::size_t target = object_index(stage.world.roster(), "target", "test");
    const ObjectShape& shape = *shapes.of(stage.world.roster().objects[target].catalogue_number);
    constexpr int steps = 20000;
    double mean = 0, most = 0;
    for (int i = 0; i < steps; ++i) {
      const SimTime t = times.at((i + 0.5) / steps);
      const double light = shape_photons_per_s_m2(
          shapes, shape, *shape_pose(view, target, t, view.observer(t).position_m), 1.0);
      mean += light / steps;
      most = std::max(most, light);
    }
    const double expected = mean * times.seconds() * Throughput(view).electrons_per_photon_m2();
    const auto frame = stage.frame(number);
    EXPECT_NEAR(target_of(frame).rendered_signal_e / expected, 1.0, 0.02) << number;
    EXPECT_GT(most, 3 * mean) << number;  // there is a glint
  }
}

TEST(Shapes, SnapshotsKeepTheLight) {
  const std::string text = scenario("    geometry: {model: box-wing, scale: 0.001}", wide);
  Stage path(text);
  std::string cut = text;
  cut.replace(cut.find("effects: {"), 10, "effects: {integration: snapshots, snapshots: 8, ");
  Stage snapshots(cut);
  EXPECT_EQ(snapshots.scenario.sensors[0].effects.snapshots(), 8);
  EXPECT_NEAR(
      target_of(snapshots.frame()).rendered_signal_e / target_of(path.frame()).rendered_signal_e,
      1.0, 1e-4);
}

TEST(Shapes, WrongGeometryPointsAtItsLine) {
  const auto complaint = [](const std::string& target, const std::string& attitude = "nadir") {
    try {
      Stage stage(scenario(target, wide, attitude));
      return std::string();
    } catch (const ConfigError& error) {
      return std::string(error.what());
    }
  };
  EXPECT_NE(complaint("    geometry: {model: bx}").find("geometry.model: must be one of"),
            std::string::npos);
  EXPECT_NE(complaint("    geometry: {model: box, material: kaptn}")
                .find("no such material, did you mean kapton?"),
            std::string::npos);
  EXPECT_NE(complaint("    geometry: {scale: 2}").find("needs either an obj file or a model"),
            std::string::npos);
  EXPECT_NE(complaint("    geometry: {obj: nowhere.obj}").find("there is no such file"),
            std::string::npos);
}

}  // namespace
}  // namespace dmise::test
