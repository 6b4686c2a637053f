#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/photometry/magnitude.h"
#include "sensors/scene/throughput.h"
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

// One sphere by its closed form and as a mesh.
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
    const View view(sensor, times, stage.states);
    const std::size_t target = object_index(stage.states.roster(), "target", "test");
    const ObjectShape& shape = *shapes.of(stage.states.roster().objects[target].catalogue_number);
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

/// Two wings of 0.5 m2 each, times the square of `scale`, reflectance 0.2 in front, on a body of
/// nothing.
std::string wings(const std::string& scale, const std::string& panel) {
  return "    geometry: {model: box-wing, body_m: [1e-5, 1e-5, 1e-5], wing_length_m: 1, "
         "wing_width_m: 0.5, front: grey, back: black-paint, scale: " +
         scale + "}\n" + panel;
}

/// Closed form, rho / pi A cos i cos r: the normal is the Sun's direction less its part along y,
/// the hinge.
double wings_m2_per_sr(const ShapePose& pose, const Vec<Body>& to_source, double scale) {
  const Vec<Body> normal = unit(Vec<Body>{pose.to_sun.x, 0, pose.to_sun.z});
  return 0.2 / pi * scale * scale * std::max(0.0, dot(normal, to_source)) *
         std::max(0.0, dot(normal, pose.to_viewer));
}

ShapePose pose_of_target(const Stage& stage, const View& view) {
  const SimTime t = view.times().middle;
  return *shape_pose(view, object_index(stage.states.roster(), "target", "test"), t,
                     view.observer(t).position_m);
}

TEST(Shapes, WingsOfAPanelAreThoseOfAPlateThatFollowsTheSun) {
  for (const std::string attitude :
       {"nadir", "sun_tracking",
        "{spinning: {axis: [0.3, 1, 0.5], rate_rpm: 0.1, phase_deg: -60}}"})
    for (const auto& [scale, optics] : {std::pair{std::string("0.02"), wide}, {"1", tele}}) {
      SCOPED_TRACE(attitude + " " + scale);
      Stage stage(scenario(wings(scale, "    panel: {}"), optics, attitude));
      const auto frame = stage.frame();
      const auto& truth = target_of(frame);
      const View view(stage.scenario.sensors.at(0), frame_times(stage.scenario.sensors.at(0), 1),
                      stage.states);
      const ShapePose pose = pose_of_target(stage, view);
      const double light =
          wings_m2_per_sr(pose, pose.to_sun, std::stod(scale)) /
          (pose.range_m * pose.range_m * pose.sun_distance_au * pose.sun_distance_au);
      EXPECT_NEAR(truth.true_magnitude, sun_v_mag + magnitude_of_light(light), 1e-3);
      EXPECT_EQ(truth.resolved, scale == "1");
      EXPECT_NEAR(truth.rendered_signal_e / expected_e(frame), 1.0, 5e-3);
      if (scale == "1") continue;
      Stage fixed(scenario(wings(scale, ""), optics, attitude));
      EXPECT_GT(std::abs(target_of(fixed.frame()).true_magnitude - truth.true_magnitude), 0.05);
    }
}

// Light from another side falls on the wings as they are turned to the Sun.
TEST(Shapes, SecondaryLightFallsOnTurnedWings) {
  Stage stage(scenario(wings("1", "    panel: {}"), tele));
  const auto& sensor = stage.scenario.sensors.at(0);
  const ObjectShapes shapes(stage.scenario.own_objects, sensor.camera.band);
  const View view(sensor, frame_times(sensor, 1), stage.states);
  ShapePose pose = pose_of_target(stage, view);
  const Vec<Body> source = unit(pose.to_sun + pose.to_viewer + Vec<Body>{0.2, 0.5, -0.3});
  pose.secondary = {{source, 0.25}};
  const ObjectShape& shape = *shapes.of(stage.scenario.own_objects.at(1).catalogue_number);
  const double expected =
      shapes.sun_photons() * 0.25 * wings_m2_per_sr(pose, source, 1) /
      (pose.range_m * pose.range_m * pose.sun_distance_au * pose.sun_distance_au);
  EXPECT_GT(expected, 0.0);
  EXPECT_NEAR(secondary_photons_per_s_m2(shapes, shape, pose) / expected, 1.0, 1e-6);
  EXPECT_NEAR(shape_photons_per_s_m2(shapes, shape, pose, 0.0) / expected, 1.0, 1e-6);
}

TEST(Shapes, APanelGivesTheSameBytesByAnyNumberOfThreads) {
  for (const std::string& optics : {wide, tele}) {
    const std::string text =
        scenario("    geometry: {model: box-wing, scale: 0.5}\n    panel: {hinge_m: [0, 0, 0.2]}",
                 optics, "{spinning: {axis: [0.3, 1, 0], rate_rpm: 7}}");
    const auto counts = [&](int threads) {
      return Stage(text, "", "", threads).frame(2).counts.pixels;
    };
    const auto one = counts(1);
    EXPECT_GT(*std::max_element(one.begin(), one.end()), 0);
    EXPECT_EQ(counts(2), one);
    EXPECT_EQ(counts(5), one);
  }
}

// A body that spins about the wings' hinge while they face the Sun, and one whose wings turn faster
// than itself.
TEST(Shapes, TurnByTheFasterOfBodyAndPanel) {
  const auto turn = [&](const std::string& attitude, const std::string& panel) {
    const Stage stage(scenario(wings("1", panel), tele, attitude));
    const View view(stage.scenario.sensors.at(0), frame_times(stage.scenario.sensors.at(0), 1),
                    stage.states);
    return turn_rad(view, object_index(stage.states.roster(), "target", "test"));
  };
  const double body = 2 * pi * 6 / 60 * 0.5;  // 6 rpm, 0.5 s
  EXPECT_NEAR(turn("{spinning: {axis: [0, 1, 0], rate_rpm: 6}}", "    panel: {}"), body, 1e-4);
  EXPECT_NEAR(turn("{spinning: {axis: [0, 0, 1], rate_rpm: 6}}", ""), body, 1e-4);
  EXPECT_GT(turn("{spinning: {axis: [0, 0, 1], rate_rpm: 6}}", "    panel: {}"), body * 1.01);
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
