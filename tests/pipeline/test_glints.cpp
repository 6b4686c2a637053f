// Light of objects that turn, beside the mean of their light at 20,000 instants.

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <set>

#include "sensors/objects/object_shapes.h"
#include "sensors/scene/throughput.h"
#include "tests/pipeline/shape_scenes.h"

namespace dmise::test {
namespace {

/// Angle by which an object turns in the exposure.
double turn_deg(const Stage& stage, const std::string& name) {
  const View view(stage.scenario.sensors.at(0), frame_times(stage.scenario.sensors[0], 1),
                  stage.states);
  return turn_rad(view, object_index(stage.states.roster(), name, "test")) / deg;
}

/// Light of an object in the frame over the mean of its light at 20,000 instants of the first
/// `period_s` of the exposure, with which it repeats itself.
double light_over_mean(Stage& stage, const std::string& name, double period_s) {
  const auto& sensor = stage.scenario.sensors.at(0);
  const ObjectShapes shapes(stage.scenario.own_objects, sensor.camera.band, sensor.effects);
  const FrameTimes times = frame_times(sensor, 1);
  const View view(sensor, times, stage.states);
  const std::size_t object = object_index(stage.states.roster(), name, "test");
  const ObjectShape& shape = *shapes.of(stage.states.roster().objects[object].catalogue_number);
  constexpr int steps = 20000;
  double mean = 0;
  for (int i = 0; i < steps; ++i) {
    const SimTime t = times.at((i + 0.5) / steps * period_s / times.seconds());
    mean += shape_photons_per_s_m2(shapes, shape,
                                   *shape_pose(view, object, t, view.observer(t).position_m), 1.0) /
            steps;
  }
  EXPECT_GT(mean, 0.0);
  return truth_named(stage.frame(), name).rendered_signal_e /
         (mean * times.seconds() * Throughput(view).electrons_per_photon_m2());
}

// A panel of 200 pixels that turns once a second: its glint of 10 ms is in the light.
TEST(Glints, AGlintShorterThanAPoseIsNotLost) {
  const Sight sight = lit_sight();
  Stage stage(text_of({.objects = shape_at("panel", sight, 1e4, 0, 0,
                                           "    attitude: {spinning: {axis: [0.1, 1, 0], rate_rpm: "
                                           "60}}\n    geometry: {model: plate, size_m: [4, 2], "
                                           "front: silicon-cell, back: silicon-cell}\n"),
                       .pointing = "{target: panel}",
                       .optics = "{columns: 128, rows: 128, pixel_pitch_m: 1.0e-5, "
                                 "focal_length_m: 1, aperture_m: 0.02}"}));
  ASSERT_TRUE(truth_named(stage.frame(), "panel").resolved);
  EXPECT_NEAR(light_over_mean(stage, "panel", frame_times(stage.scenario.sensors[0], 1).seconds()),
              1.0, 0.02);
}

/// A file of this process, above the directories of its scenes.
std::string mirror_file(const std::string& ending, const std::string& directory) {
  return directory + "/mirror" + ending;
}

struct Mirror {
  std::string size_m, focal_length_m;
};
const Mirror mirrors[] = {{"4, 2", "1"}, {"0.1, 0.1", "0.05"}};  // resolved, a point

std::string mirror_scene(const Mirror& mirror, const std::string& attitude, double exposure_s) {
  std::ofstream(mirror_file(".yaml", testing::TempDir()))
      << "materials:\n  mirror: {model: phong, diffuse: 0, specular: 0.9, exponent: 20000}\n";
  std::string text =
      text_of({.objects = shape_at("mirror", lit_sight(), 1e4, 0, 0,
                                   "    attitude: " + attitude +
                                       "\n    geometry: {model: plate, size_m: [" + mirror.size_m +
                                       "], front: mirror, back: mirror, materials: " +
                                       mirror_file(".yaml", "..") + "}\n"),
               .pointing = "{target: mirror}",
               .optics = "{columns: 128, rows: 128, pixel_pitch_m: 1.0e-5, "
                         "focal_length_m: " +
                         mirror.focal_length_m + ", aperture_m: 0.002}",
               .exposure_s = exposure_s});
  return text.replace(text.find("tick_s: 5"), 9, "tick_s: 1");
}

/// The direction of a normal that sends sunlight to the camera.
Vec<Gcrs> glint_normal() {
  const Stage any(text_of({.objects = "", .pointing = "zenith"}));
  return unit(unit(any.states.environment({0}).sun_m) - lit_sight().line);
}

// Half a degree of a mirror's turn sends its light to the camera: at 60 rpm for 1.4 ms, in
// exposures of many turns, at rates that repeat themselves in 10 ms and in each arc.
TEST(Glints, AGlintOfAMirrorThatTurnsManyTimesIsNotLost) {
  const Vec<Gcrs> axis = unit(cross(Vec<Gcrs>{0, 0, 1}, glint_normal()));
  for (const auto& [rpm, exposure_s] : {std::pair{60.0, 4.0}, {6000.0, 1.0}, {3840.0, 2.0}})
    for (const Mirror& mirror : mirrors) {
      char spin[256];
      std::snprintf(spin, sizeof spin, "{spinning: {axis: [%.12f, %.12f, %.12f], rate_rpm: %g}}",
                    axis.x, axis.y, axis.z, rpm);
      Stage stage(mirror_scene(mirror, spin, exposure_s));
      EXPECT_NEAR(turn_deg(stage, "mirror") / (6 * rpm * exposure_s), 1.0, 1e-4);
      EXPECT_NEAR(light_over_mean(stage, "mirror", 60 / rpm), 1.0, 0.05)
          << rpm << " rpm, " << exposure_s << " s, " << mirror.size_m;
    }
}

// Turned by 40 deg within a second and at rest before the exposure ends.
TEST(Glints, AGlintBeforeTheObjectComesToRestIsNotLost) {
  const Vec<Gcrs> normal = glint_normal(), axis = unit(cross(Vec<Gcrs>{0, 0, 1}, normal));
  const double glint_rad = angle_rad(Vec<Gcrs>{0, 0, 1}, normal);
  std::ofstream table(mirror_file(".csv", testing::TempDir()));
  table << "time_s,w,x,y,z\n" << std::setprecision(15);
  for (const auto& [time_s, from_deg] :
       {std::pair{0, -20.0}, {1, -20.0}, {2, 20.0}, {3, 20.0}, {12, 20.0}}) {
    const double half_rad = (glint_rad + from_deg * deg) / 2, s = std::sin(half_rad);
    table << time_s << ',' << std::cos(half_rad) << ',' << s * axis.x << ',' << s * axis.y << ','
          << s * axis.z << '\n';
  }
  table.close();
  for (const Mirror& mirror : mirrors) {
    Stage stage(mirror_scene(mirror, "{table: " + mirror_file(".csv", "..") + "}", 4.5));
    EXPECT_GE(turn_deg(stage, "mirror"), 40.0);
    EXPECT_LE(turn_deg(stage, "mirror"), 60.0);
    EXPECT_NEAR(light_over_mean(stage, "mirror", 4.5), 1.0, 0.02) << mirror.size_m;
  }
}

// A satellite that passes the camera and does not turn: the bisector turns by a few degrees, and
// its parts glint within tenths of a second.
TEST(Glints, ThoseOfSmallPartsAreInTheLightOfATrail) {
  const Sight sight = lit_sight();
  for (const double speed_m_per_s : {0.0, 500.0, 3000.0}) {
    const Vec<Gcrs> r = eye_m + sight.line * 1e5, v = sight.right * speed_m_per_s;
    char object[512];
    std::snprintf(object, sizeof object,
                  "  - name: passing\n    motion: {two_body: {position_m: [%.3f, %.3f, %.3f], "
                  "velocity_m_per_s: [%.6f, %.6f, %.6f]}}\n    attitude: {inertial: "
                  "{gcrs_from_body: [1, 0, 0, 0]}}\n    model: oneweb\n",
                  r.x, r.y, r.z, v.x, v.y, v.z);
    Stage stage(text_of({.objects = object,
                         .pointing = "{target: passing}",
                         .optics = "{columns: 128, rows: 128, pixel_pitch_m: 1.0e-5, "
                                   "focal_length_m: 0.05, aperture_m: 0.002}",
                         .exposure_s = 4.5}));
    EXPECT_NEAR(light_over_mean(stage, "passing", 4.5), 1.0, 0.005) << speed_m_per_s;
  }
}

// The seed and the object decide what glints, the effect switches it off.
TEST(Glints, ThoseOfSmallPartsCanBeSwitchedOff) {
  const auto signal_e = [](const std::string& name, int seed, const std::string& effects) {
    Stage stage(text_of({.objects = shape_at(name, lit_sight(), 1e5, 0, 0,
                                             "    attitude: {inertial: {gcrs_from_body: [1, 0, 0, "
                                             "0]}}\n    model: oneweb\n"),
                         .pointing = "{target: " + name + "}",
                         .optics = "{columns: 128, rows: 128, pixel_pitch_m: 1.0e-5, "
                                   "focal_length_m: 0.05, aperture_m: 0.002}",
                         .effects = "sky: off, " + effects,
                         .seed = seed}));
    return truth_named(stage.frame(), name).rendered_signal_e;
  };
  const double smooth = signal_e("a", 1, "glints: off, ");
  EXPECT_NEAR(signal_e("b", 2, "glints: off, ") / smooth, 1.0, 1e-12);
  const double a = signal_e("a", 1, "");
  EXPECT_EQ(signal_e("a", 1, ""), a);
  // A lobe of the parts of a few reaches the camera; of the light of the others they take a part.
  std::set<double> of_seeds, of_names;
  for (int k = 1; k <= 25; ++k) {
    of_seeds.insert(signal_e("a", k, ""));
    of_names.insert(signal_e(std::string(1, char('a' + k)), 1, ""));
  }
  EXPECT_GT(of_seeds.size(), 2u);
  EXPECT_GT(of_names.size(), 2u);
  EXPECT_LT(*of_seeds.begin(), 0.9 * smooth);
  EXPECT_GT(*of_seeds.rbegin(), smooth);
}

}  // namespace
}  // namespace dmise::test
