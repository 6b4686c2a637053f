#include <cmath>
#include <cstdio>

#include "core/base/units.h"
#include "core/facets/moonlight.h"
#include "core/photometry/magnitude.h"
#include "core/sky/bodies/moon_disc.h"
#include "tests/pipeline/shape_scenes.h"
#include "tests/pipeline/wiring.h"

namespace dmise::test {
namespace {

std::string gcrs(const Vec<Gcrs>& r) {
  char text[128];
  std::snprintf(text, sizeof text, "motion: {fixed: {gcrs_m: [%.3f, %.3f, %.3f]}}", r.x, r.y, r.z);
  return text;
}

/// An object at `at_m`, seen from 10,000 km on its side to the Moon.
std::string scene(const Vec<Gcrs>& at_m, const Vec<Gcrs>& eye_m, const std::string& shape,
                  bool moonlight) {
  return scenario(
      "2018-01-21T00:15:00Z", 5, "platform: eye", camera(128, 128, 1.0, "", ", aperture_m: 1"),
      "{target: target}", 0.5, 5,
      ", sky: space, detection: off, effects: {" + noiseless +
          ", moon_disc: off, earth_disc: off, moonlight: " + (moonlight ? "on}" : "off}"),
      "",
      "objects:\n  - name: eye\n    " + gcrs(eye_m) + "\n  - name: target\n    " + gcrs(at_m) +
          "\n" + shape);
}

Truth truth_of(const std::string& yaml) { return truth_named(Stage(yaml).frame(), "target"); }

double signal_e(const std::string& yaml) { return truth_of(yaml).rendered_signal_e; }

/// Sun and Moon at the start.
const EnvironmentState& bodies() {
  static const EnvironmentState environment =
      Stage(scene({4.2e7, 0, 0}, {4.3e7, 0, 0}, "", false)).states.environment({0});
  return environment;
}

// In the Earth's umbra at the height of geosynchronous orbits. The magnitude is that of Krisciunas
// & Schaefer 1991, the sphere Lambert's, both written out here.
TEST(MoonlightEffect, LightsSpheresMeshesAndShapesInTheEarthsShadow) {
  const Vec<Gcrs> at_m = unit(bodies().sun_m) * -42164e3;
  const Vec<Gcrs> to_moon = bodies().moon_m - at_m;
  const Vec<Gcrs> eye_m = at_m + unit(to_moon + Vec<Gcrs>{0, 0, 2e8}) * 1e7;
  const std::string mesh =
      "    attitude: nadir\n    geometry: {model: sphere, facets: 5000, material: white, "
      "materials: " DMISE_SOURCE_DIR "/tests/pipeline/plain.yaml, radius_m: ";
  struct Case {
    double radius_m;
    std::string shape;
  };
  for (const auto& [radius_m, shape] : {Case{100, "    radius_m: 100\n    albedo: 0.8\n"},
                                        Case{10, mesh + "10}\n"}, Case{1000, mesh + "1000}\n"}}) {
    Stage stage(scene(at_m, eye_m, shape, true));
    const Camera& camera = stage.scenario.sensors[0].camera;
    const double phase_deg = angle_rad(bodies().sun_m - bodies().moon_m, -to_moon) / deg;
    const double v_mag = -12.73 + 0.026 * phase_deg + 4e-9 * std::pow(phase_deg, 4) +
                         5 * std::log10(norm(to_moon) / 384.4e6);
    const double a = angle_rad(to_moon, eye_m - at_m), size = radius_m / 1e7;
    const double expected = moonlight_photons_per_s_m2(v_mag, camera.band) * 0.8 * size * size *
                            2.0 / (3 * pi) * (std::sin(a) + (pi - a) * std::cos(a)) * pi / 4 *
                            camera.optics.transmission * camera.detector.quantum_efficiency * 0.5;
    EXPECT_NEAR(signal_e(scene(at_m, eye_m, shape, true)) / expected, 1.0, 0.02) << shape;
    EXPECT_EQ(signal_e(scene(at_m, eye_m, shape, false)), 0.0) << shape;
  }
}

// Between the camera and the Sun, 0.35 deg beside it: a crescent that the Moon makes 4 %
// brighter. The light drawn and the magnitude in the truth change alike.
TEST(MoonlightEffect, IsInTheTrueMagnitudeAsInTheLightDrawn) {
  const Vec<Gcrs> at_m = unit(cross(bodies().sun_m, bodies().moon_m)) * 42164e3;
  const Vec<Gcrs> to_sun = unit(bodies().sun_m - at_m), to_moon = unit(bodies().moon_m - at_m);
  const Vec<Gcrs> beside = unit(to_moon - to_sun * dot(to_moon, to_sun));
  const Vec<Gcrs> eye_m = at_m + unit(beside * std::tan(0.35 * deg) - to_sun) * 1e7;
  const std::string ball = "    radius_m: 100\n    albedo: 0.8\n";
  const Truth without = truth_of(scene(at_m, eye_m, ball, false));
  const Truth with = truth_of(scene(at_m, eye_m, ball, true));
  EXPECT_GT(with.rendered_signal_e, 1.03 * without.rendered_signal_e);
  EXPECT_NEAR(without.true_magnitude - with.true_magnitude,
              2.5 * std::log10(with.rendered_signal_e / without.rendered_signal_e), 2e-3);
}

TEST(MoonlightEffect, StopsWhereTheEarthIsBeforeTheMoon) {
  const Vec<Gcrs> at_m = unit(bodies().moon_m) * -7000e3;
  const Vec<Gcrs> eye_m = at_m * 2.5;
  const std::string ball = "    radius_m: 1000\n";
  EXPECT_EQ(signal_e(scene(at_m, eye_m, ball, true)), signal_e(scene(at_m, eye_m, ball, false)));
}

TEST(MoonlightEffect, IsOffUnlessAskedFor) { EXPECT_FALSE(EffectSet().has(Moonlight::facts)); }

}  // namespace
}  // namespace dmise::test
