#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"
#include "core/facets/facet_light.h"
#include "core/materials/obj_file.h"
#include "core/materials/shapes.h"
#include "tests/support/directions.h"

namespace dmise {
namespace {

Material lambert(double reflectance) {
  Material m;
  m.reflectance = {{0.55e-6}, {reflectance}};
  return m;
}

/// Two wings of 10 m2 on a body of a micrometre, dark behind.
FacetLight wings() {
  return FacetLight(box_wing({.body_m = {1e-6, 1e-6, 1e-6}, .wing_length_m = 5, .wing_width_m = 2},
                             lambert(0), lambert(0.3), lambert(0)),
                    Band{});
}

// Closed form: rho / pi A cos i cos r, with the normal in the Sun's direction less its part along
// the hinge.
TEST(PanelLight, OfWingsIsThatOfAPlateThatFollowsTheSun) {
  const FacetLight object = wings();
  const auto directions = even_directions<Body>(60);
  int seen = 0;
  for (std::size_t i = 0; i < 60; ++i) {
    const Vec<Body> sun = directions[i], viewer = directions[(7 * i + 3) % 60];
    const Vec<Body> normal = unit(Vec<Body>{sun.x, 0, sun.z});
    const double expected = 0.3 / pi * 20.0 * dot(normal, sun) * std::max(0.0, dot(normal, viewer));
    EXPECT_NEAR(object.turned({}, sun).reflected_m2_per_sr(sun, viewer), expected, 1e-6) << i;
    seen += expected > 0.01;
  }
  EXPECT_GT(seen, 20);
}

TEST(PanelLight, WithTheSunAlongTheHingeIsAtRest) {
  const FacetLight object = wings();
  for (const double y : {1.0, -1.0}) {
    const FacetLight turned = object.turned({}, {0, y, 0});
    for (std::size_t i = 0; i < object.mesh().vertex_m.size(); ++i)
      EXPECT_NEAR(norm(turned.mesh().vertex_m[i] - object.mesh().vertex_m[i]), 0.0, 1e-14);
    EXPECT_NEAR(turned.reflected_m2_per_sr({0, y, 0}, {0, 0, 1}), 0.0, 1e-12);
  }
}

TEST(PanelLight, OfWingsEdgeOnIsNothing) {
  const FacetLight object = wings();
  for (const auto& sun : even_directions<Body>(30)) {
    const Vec<Body> edge = unit(Vec<Body>{sun.z, 0, -sun.x});
    for (const Vec<Body>& viewer : {edge, -edge, Vec<Body>{0, 1, 0}})
      EXPECT_NEAR(object.turned({}, sun).reflected_m2_per_sr(sun, viewer), 0.0, 1e-10);
  }
}

// A black sheet of 1 m2 turns above a white ground of 16 m2, 1 m below. With the Sun 60 deg from
// the zenith its shadow is 2 m long about -tan 60 deg, from -2 m on beside the ground; the viewer
// in the zenith misses cos 60 deg m2 of the ground under it.
TEST(PanelLight, ThrowsTheShadowOfItsAngle) {
  Mesh sheet = plate(1, 1, lambert(0), lambert(0));
  for (auto& t : sheet.triangles) t.panel = true;
  const FacetLight object(merged(moved(plate(4, 4, lambert(0.5), lambert(0.5)), {0, 0, -1}), sheet),
                          Band{});
  const Vec<Body> sun{std::sin(60 * deg), 0, std::cos(60 * deg)}, up{0, 0, 1};
  const double shadow_m2 = 2.0 - (std::tan(60 * deg) - 1.0);
  EXPECT_NEAR(object.turned({}, sun).reflected_m2_per_sr(sun, up),
              (16 - shadow_m2 - 0.5) * 0.5 / pi * sun.z, 1e-9);
  // About a hinge 1 m up: the sheet is 1 m lower than the hinge along the Sun's ray.
  const FacetLight hung = object.turned({{}, {0, 0, 1}}, sun);
  const Vec<Body> middle = (hung.mesh().vertex_m[8] + hung.mesh().vertex_m[10]) / 2;
  EXPECT_NEAR(norm(middle - (Vec<Body>{0, 0, 1} - sun)), 0.0, 1e-14);
}

/// A square with a picture of heights that rises to the right.
Mesh bumpy() {
  LinearPicture slope{16, 16, 1, {}};
  for (int i = 0; i < 256; ++i) slope.pixels.push_back(float(i % 16 + (i / 16) % 3) / 20.0f);
  return parse_obj(
             "mtllib a.mtl\nusemtl hull\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\n"
             "vt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n",
             "a.obj",
             {[](const std::string&) {
                return std::string(
                    "newmtl hull\nKd 0.5 0.5 0.5\nKs 0.3 0.3 0.3\nNs 9\nmap_Bump -bm 0.4 h.png\n");
              },
              [](std::string_view) { return std::optional<Material>(); },
              [&](const std::string&, PictureOf) { return slope; }})
      .mesh;
}

// A rotation of everything changes nothing: normals, lobes and bumps turn with the panel. Where
// parts cross, shadows move by the slack, some 1e-7 of the size.
TEST(PanelLight, OfAnObjectThatIsAllPanelIsThatOfDirectionsTurnedBack) {
  const Material shiny = sandford_robertson_of("shiny", {{0.55e-6}, {0.5}}, 0.3, 0.3, 0.3);
  for (Mesh mesh : {box({1, 2, 3}, shiny), merged(box({1, 1, 1}, shiny), bumpy())}) {
    for (auto& t : mesh.triangles) t.panel = true;
    const FacetLight object(mesh, Band{});
    const HingedPanel panel{{.hinge = unit(Vec<Body>{1, 1, 0})}, {0.3, -0.2, 0.1}};
    const auto directions = even_directions<Body>(40);
    for (std::size_t i = 0; i < 40; ++i) {
      const Vec<Body> sun = directions[i], viewer = directions[(11 * i + 5) % 40];
      const auto back = panel_rotation(panel.axes, sun).inverse();
      const FacetLight turned = object.turned(panel, sun);
      EXPECT_EQ(turned.convex(), object.convex());
      const double expected = object.reflected_m2_per_sr(back * sun, back * viewer);
      EXPECT_NEAR(turned.reflected_m2_per_sr(sun, viewer), expected, 1e-6);
    }
  }
}

TEST(PanelLight, OfWarmWingsFollowsThem) {
  const Band thermal{.centre_m = 10 * um, .width_m = 1 * um};
  Material warm;
  warm.temperature_k = 300;
  warm.thermal_emissivity = 0.9;
  Material cold = warm;
  cold.temperature_k = 0;
  const FacetLight object(
      box_wing({.body_m = {1e-6, 1e-6, 1e-6}, .wing_length_m = 5, .wing_width_m = 2}, cold, warm,
               cold),
      thermal);
  const double whole = object.emitted_photons_per_s_sr({0, 0, 1});
  const Vec<Body> viewer = unit(Vec<Body>{0.3, 0.5, 0.4});
  for (const auto& sun : even_directions<Body>(20)) {
    const Vec<Body> normal = unit(Vec<Body>{sun.x, 0, sun.z});
    EXPECT_NEAR(object.turned({}, sun).emitted_photons_per_s_sr(viewer) / whole,
                std::max(0.0, dot(normal, viewer)), 1e-6);
  }
}

}  // namespace
}  // namespace dmise
