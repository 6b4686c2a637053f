#include "core/materials/panel.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"
#include "core/materials/obj_file.h"
#include "core/materials/shapes.h"
#include "tests/support/directions.h"

namespace dmise {
namespace {

ObjModel parse(const std::string& text, bool names_panel = true) {
  return parse_obj("usemtl grey\n" + text, "a.obj",
                   {.read_mtl = [](const std::string&) { return std::string(); },
                    .library = [](std::string_view) { return std::optional(Material{}); },
                    .read_picture = {},
                    .names_panel = names_panel});
}

std::size_t panel_facets(const Mesh& mesh) {
  return std::size_t(std::ranges::count_if(mesh.triangles, &Mesh::Triangle::panel));
}

const std::string corners =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n";
const std::string open_box = "f 1 4 3 2\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

/// The directions to which a normal of z turns about y for Suns in these: no part along y.
Vec<Body> towards(const Vec<Body>& sun) { return unit(Vec<Body>{sun.x, 0, sun.z}); }

TEST(Panel, FacesTheSunAsWellAsItsHingeAllows) {
  const SunTrackingPanel wings;
  for (const auto& sun : even_directions<Body>(50)) {
    const Vec<Body> normal = panel_rotation(wings, sun) * Vec<Body>{0, 0, 1};
    EXPECT_NEAR(angle_rad(normal, towards(sun)), 0.0, 1e-14);
    EXPECT_NEAR(norm(panel_rotation(wings, sun) * wings.hinge - wings.hinge), 0.0, 1e-15);
  }
  EXPECT_NEAR((panel_rotation(wings, {0, -1, 0}) * Vec<Body>{0, 0, 1}).z, 1.0, 1e-15);
}

TEST(Panel, TurnsAboutItsHingeAndLeavesTheRest) {
  const Mesh rest = box_wing({}, {}, {}, {});
  Mesh turned = rest;
  turn_panel(turned, {0, 0, 1}, panel_rotation({}, {1, 0, 0}));  // z to x, about (0, y, 1)
  const auto turns = panel_vertices(rest);
  for (std::size_t i = 0; i < turns.size(); ++i) {
    const Vec<Body>& v = rest.vertex_m[i];
    const Vec<Body> expected = turns[i] ? Vec<Body>{v.z - 1, v.y, 1 - v.x} : v;
    EXPECT_NEAR(norm(turned.vertex_m[i] - expected), 0.0, 1e-14);
    EXPECT_EQ(turns[i], i >= 8);  // the first eight are the box
  }
  EXPECT_EQ(panel_facets(rest), 8u);
  EXPECT_EQ(turned.triangles, rest.triangles);
}

TEST(Panel, OfAStarlinkHangsOnTheEdgeOfItsArray) {
  const Mesh rest = starlink_like({}, {}, {});
  const HingedPanel panel = starlink_like_panel();
  Mesh open = rest;  // the Sun in the zenith: an open book
  turn_panel(open, panel.hinge_m, panel_rotation(panel.axes, {0, 0, -1}));
  double min_y = 0, max_y = -1e9;
  const auto turns = panel_vertices(rest);
  for (std::size_t i = 0; i < turns.size(); ++i) {
    if (!turns[i]) continue;
    EXPECT_NEAR(open.vertex_m[i].z, -0.2, 1e-14);
    min_y = std::min(min_y, open.vertex_m[i].y);
    max_y = std::max(max_y, open.vertex_m[i].y);
  }
  EXPECT_NEAR(max_y, 0.0, 1e-14);
  EXPECT_NEAR(min_y, -8.0, 1e-14);  // 22 m2 of 2.75 m
}

// The farthest vertex over all angles in steps of 0.1 deg: short of the circle by 4e-7 at most.
TEST(Panel, IsWithinItsRadiusAtEveryAngle) {
  for (const auto& [mesh, panel] :
       {std::pair{box_wing({}, {}, {}, {}), HingedPanel{{}, {1, 2, 3}}},
        {box_wing({}, {}, {}, {}), HingedPanel{{.hinge = unit(Vec<Body>{1, 1, 0})}, {}}},
        {starlink_like({}, {}, {}), starlink_like_panel()}}) {
    double max_m = 0;
    for (int i = 0; i < 3600; ++i) {
      const double angle = i * 0.1 * deg;
      const Vec<Body> across = cross(panel.axes.hinge, panel.axes.normal);
      Mesh turned = mesh;
      turn_panel(turned, panel.hinge_m,
                 panel_rotation(panel.axes,
                                panel.axes.normal * std::cos(angle) + across * std::sin(angle)));
      max_m = std::max(max_m, radius_m(turned));
    }
    EXPECT_NEAR(max_m / radius_m(mesh, panel), 1.0, 1e-6);
    EXPECT_LE(max_m, radius_m(mesh, panel) * (1 + 1e-15));
  }
}

TEST(Panel, OfAnObjAreObjectsAndGroupsOfThatName) {
  const std::string face = "f 1 2 3\n";
  const auto facets = [&](const std::string& names) {
    return panel_facets(parse(corners + names + face).mesh) / 2;  // a sheet has a back
  };
  EXPECT_EQ(facets(""), 0u);
  EXPECT_EQ(facets("o panel\n"), 1u);
  EXPECT_EQ(facets("g Panel_left\n"), 1u);
  EXPECT_EQ(facets("g wing PANELS\n"), 1u);  // in several groups
  EXPECT_EQ(facets("o solar panel\n"), 0u);  // one name with a blank
  EXPECT_EQ(facets("g solar-panel\n"), 0u);  // does not begin so
  EXPECT_EQ(facets("g pane\n"), 0u);
  EXPECT_EQ(facets("o panel\ng cells\n"), 1u);  // a group of that object
  EXPECT_EQ(facets("g panel\no bus\n"), 0u);    // another object
  EXPECT_EQ(facets("g panel\ng\n"), 0u);        // the group without a name
  EXPECT_EQ(panel_facets(parse(corners + "g panel\n" + face, false).mesh), 0u);
}

// A box whose lid turns: both are sheets, of which each has its corners.
TEST(Panel, OfAnObjHasCornersAndSidesOfItsOwn) {
  const auto model = parse(corners + open_box + "g panel-lid\nf 5 6 7 8\n");
  EXPECT_EQ(model.mesh.triangles.size(), 24u);
  EXPECT_EQ(panel_facets(model.mesh), 4u);
  EXPECT_EQ(model.mesh.vertex_m.size(), 12u);
  EXPECT_EQ(model.notes.size(), 2u);
  Mesh opened = model.mesh;
  turn_panel(opened, {0, 0, 1}, panel_rotation({}, {-1, 0, 0}));
  for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(opened.vertex_m[i], model.mesh.vertex_m[i]);
  for (const auto& v : {Vec<Body>{0, 0, 1}, {0, 0, 2}, {0, 1, 1}, {0, 1, 2}})
    EXPECT_TRUE(std::ranges::any_of(opened.vertex_m,
                                    [&](const Vec<Body>& own) { return norm(own - v) < 1e-15; }))
        << v.y << " " << v.z;
  // Without the panel it is the closed box.
  EXPECT_EQ(parse(corners + open_box + "g panel-lid\nf 5 6 7 8\n", false).mesh,
            parse(corners + open_box + "f 5 6 7 8\n").mesh);
}

// A normal that is not square to the hinge: the stated one counts, not its part across the hinge.
TEST(Panel, MayBeCantedAgainstItsHinge) {
  const Mesh canted = parse("v -1 -1 -2\nv 1 -1 -2\nv 1 1 2\nv -1 1 2\no panel\nf 1 2 3 4\n").mesh;
  EXPECT_TRUE(faces_normal(canted, {.normal = {0, -2, 1}}));
  EXPECT_FALSE(faces_normal(canted, {.normal = {0, 0, 1}}));
}

TEST(Panel, HasAFacetThatFacesItsNormal) {
  const Mesh wings = box_wing({}, {}, {}, {}), array = starlink_like({}, {}, {});
  EXPECT_TRUE(faces_normal(wings, {}));
  EXPECT_TRUE(faces_normal(wings, {.normal = {0, 0.9, -1}}));
  EXPECT_FALSE(faces_normal(wings, {.normal = {0, 1.1, 1}}));  // 47.7 deg, though 0 about the hinge
  EXPECT_FALSE(faces_normal(wings, {.hinge = {0, 0, 1}, .normal = {0, 1, 0}}));
  EXPECT_TRUE(faces_normal(array, starlink_like_panel().axes));
  EXPECT_FALSE(faces_normal(array, {}));
  EXPECT_FALSE(has_panel(box({1, 1, 1}, {})));
}

}  // namespace
}  // namespace dmise
