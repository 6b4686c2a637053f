#include "core/facets/earthshine.h"

#include "core/facets/earthshine.h"
#include "core/sky/bodies/shadow.h"
#include "tests/pipeline/shape_scenes.h"

namespace dmise::test {
namespace {

/// A camera above an object at 7000 km from the Earth's centre, on its side to the Sun; both fixed.
/// The Earth lights the object from below, which is seen from the side.
std::string scene(const std::string& shape, bool earthshine) {
  return text_of(
      {.objects = "  - name: target\n    motion: {fixed: {gcrs_m: [7000000, 0, 0]}}\n" + shape,
       .pointing = "{target: target}",
       .optics = "{columns: 128, rows: 128, pixel_pitch_m: 1.0e-5, focal_length_m: 1, "
                 "aperture_m: 1}",
       .effects = std::string("sky: off, earthshine: ") + (earthshine ? "on, " : "off, ")});
}

double signal_e(const std::string& shape, bool earthshine) {
  return truth_named(Stage(scene(shape, earthshine)).frame(), "target").rendered_signal_e;
}

// Against the closed sum over 96 rings: the share of earthshine in a sphere's light, as a diffuse
// sphere, as a mesh that is drawn as a point, and as one with a shape.
TEST(EarthshineEffect, LightsSpheresMeshesAndShapesAlike) {
  const std::string mesh =
      "    attitude: nadir\n    geometry: {model: sphere, facets: 5000, "
      "material: white, materials: " DMISE_SOURCE_DIR "/tests/pipeline/plain.yaml, radius_m: ";
  const Stage any(scene("    radius_m: 1\n", false));
  const Vec<Gcrs> at{7000e3, 0, 0}, sun_m = any.states.environment({0}).sun_m;
  const auto as_body = [](const Vec<Gcrs>& v) { return Vec<Body>{v.x, v.y, v.z}; };
  const Vec<Body> to_sun = as_body(unit(sun_m - at)), to_eye = as_body(unit(eye_m - at));
  double expected = 0;
  for (const auto& source : earthshine_sources({.rings = 96}, as_body(-at), to_sun))
    expected += source.share * diffuse_phase_function(angle_rad(source.to_source, to_eye));
  expected /= diffuse_phase_function(angle_rad(to_sun, to_eye));
  EXPECT_GT(expected, 0.01);
  for (const std::string& shape :
       {std::string("    radius_m: 1\n    albedo: 0.8\n"), mesh + "1}\n", mesh + "100}\n"}) {
    const double without = signal_e(shape, false), with = signal_e(shape, true);
    EXPECT_GT(without, 0.0);
    EXPECT_NEAR((with - without) / without / expected, 1.0, 0.02) << shape;
  }
}

// The light drawn and the magnitude in the truth change alike.
TEST(EarthshineEffect, IsInTheTrueMagnitudeAsInTheLightDrawn) {
  const std::string mesh =
      "    attitude: nadir\n    geometry: {model: sphere, facets: 5000, "
      "material: white, materials: " DMISE_SOURCE_DIR "/tests/pipeline/plain.yaml, radius_m: 1}\n";
  for (const std::string& shape : {std::string("    radius_m: 1\n    albedo: 0.8\n"), mesh}) {
    const Truth without = truth_named(Stage(scene(shape, false)).frame(), "target");
    const Truth with = truth_named(Stage(scene(shape, true)).frame(), "target");
    EXPECT_GT(with.rendered_signal_e, 1.005 * without.rendered_signal_e);
    EXPECT_NEAR(without.true_magnitude - with.true_magnitude,
                2.5 * std::log10(with.rendered_signal_e / without.rendered_signal_e), 2e-3)
        << shape;
  }
}

TEST(EarthshineEffect, IsOffUnlessAskedFor) {
  EXPECT_FALSE(EffectSet().has(Earthshine::facts));
  const Stage stage(scene("    radius_m: 1\n", true));
  EXPECT_TRUE(stage.scenario.sensors[0].effects.has(Earthshine::facts));
}

}  // namespace
}  // namespace dmise::test
