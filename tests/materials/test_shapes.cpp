#include "core/materials/shapes.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/units.h"

namespace dmise {
namespace {

/// Volume within the surface [m3]: positive when it faces outwards.
double volume_m3(const Mesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles)
    sum += dot(mesh.vertex_m[t.corner[0]],
               cross(mesh.vertex_m[t.corner[1]], mesh.vertex_m[t.corner[2]]));
  return sum / 6;
}

TEST(Shapes, HaveTheirSurfaceAndVolumeAndFaceOutwards) {
  EXPECT_NEAR(surface_m2(box({1, 2, 3}, {})), 22.0, 1e-12);
  EXPECT_NEAR(volume_m3(box({1, 2, 3}, {})), 6.0, 1e-12);
  EXPECT_NEAR(surface_m2(plate(2, 3, {}, {})), 12.0, 1e-12);  // front and back
  const Mesh ball = sphere(2.0, 5000, {});
  EXPECT_EQ(ball.triangles.size(), 4500u);  // 20 x 15^2
  EXPECT_NEAR(surface_m2(ball), 16 * pi, 16 * pi * 2e-3);
  EXPECT_NEAR(volume_m3(ball), 32 * pi / 3, 32 * pi / 3 * 3e-3);
  const Mesh tube = cylinder(1.0, 3.0, 200, {});
  EXPECT_NEAR(surface_m2(tube), 2 * pi * 3 + 2 * pi, 8 * pi * 1e-3);
  EXPECT_NEAR(volume_m3(tube), 3 * pi, 3 * pi * 1e-3);
}

TEST(Shapes, StarlinkLikeHasTheAreasOfItsModel) {
  Material chassis, front, back;
  chassis.name = "chassis";
  front.name = "front";
  back.name = "back";
  const Mesh mesh = starlink_like(chassis, front, back);
  double nadir_m2 = 0, front_m2 = 0, back_m2 = 0;
  for (const auto& t : mesh.triangles) {
    const Vec<Body> area = double_area_m2(mesh, t) / 2;
    const std::string& name = mesh.materials[t.material].name;
    if (name == "chassis" && area.z > 0) nadir_m2 += area.z;
    if (name == "front") front_m2 += area.y;
    if (name == "back") back_m2 -= area.y;
  }
  EXPECT_NEAR(nadir_m2, 3.65, 1e-12);
  EXPECT_NEAR(front_m2, 22.0, 1e-12);
  EXPECT_NEAR(back_m2, 22.0, 1e-12);
}

TEST(Shapes, ThatHideNothingOfThemselvesAreKnownAsConvex) {
  EXPECT_TRUE(is_convex(box({1, 2, 3}, {})));
  EXPECT_TRUE(is_convex(sphere(1, 320, {})));
  EXPECT_TRUE(is_convex(cylinder(1, 2, 30, {})));
  EXPECT_TRUE(is_convex(plate(1, 2, {}, {})));
  EXPECT_FALSE(is_convex(box_wing({}, {}, {}, {})));
}

TEST(Shapes, ABoxWingHasAnotherMaterialTowardsZ) {
  const Material body{.name = "body"}, towards_z{.name = "towards z"};
  const Mesh mesh = box_wing({}, body, {}, {}, towards_z);
  double area_m2 = 0.0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& t = mesh.triangles[i];
    if (mesh.materials[t.material].name != "towards z") continue;
    const Vec<Body> a = mesh.vertex_m[t.corner[0]];
    const Vec<Body> normal =
        cross(mesh.vertex_m[t.corner[1]] - a, mesh.vertex_m[t.corner[2]] - a) / 2.0;
    EXPECT_NEAR(normal.z, norm(normal), 1e-15);
    area_m2 += normal.z;
  }
  EXPECT_NEAR(area_m2, BoxWing{}.body_m.x * BoxWing{}.body_m.y, 1e-12);
}

// The finest sphere, too: all pairs of facets and vertices would take half a minute for it.
TEST(Shapes, OfManyFacetsAreKnownAsConvexUpToASmallDent) {
  Mesh fine = sphere(1, 200'000, {});
  EXPECT_TRUE(is_convex(fine));
  fine.vertex_m[54'321] = fine.vertex_m[54'321] * (1.0 - 1e-4);
  EXPECT_FALSE(is_convex(fine));
  EXPECT_FALSE(is_convex(merged(sphere(1, 2000, {}), moved(box({1, 1, 1}, {}), {0.0, 2.0, 0.3}))));
}

TEST(Shapes, OfNoSizeAreRefused) {
  EXPECT_THROW(box({0, 1, 1}, {}), Error);
  EXPECT_THROW(sphere(1, 19, {}), Error);
  EXPECT_THROW(cylinder(1, 1, 2, {}), Error);
  EXPECT_THROW(plate(-1, 1, {}, {}), Error);
}

}  // namespace
}  // namespace dmise
