#include "core/materials/mesh.h"

#include <gtest/gtest.h>

#include "core/materials/mesh_repair.h"
#include "core/materials/shapes.h"

namespace dmise {
namespace {

TEST(Mesh, MergingSharesEqualMaterials) {
  Material a, b;
  b.name = "other";
  const Mesh both = merged(merged(box({1, 1, 1}, a), box({1, 1, 1}, b)), box({1, 1, 1}, a));
  EXPECT_EQ(both.materials.size(), 2u);
  EXPECT_EQ(both.triangles.size(), 36u);
  EXPECT_EQ(both.triangles.back().material, 0u);
}

TEST(Mesh, TwoBoxesThatTouchAlongAnEdgeAreTwoClosedSurfaces) {
  Mesh mesh = merged(box({1, 1, 1}, {}), moved(box({1, 1, 1}, {}), {1, 1, 0}));
  const Mesh before = mesh;
  EXPECT_TRUE(repair(mesh, {"m", std::vector<std::uint32_t>(24, 1)}).empty());
  EXPECT_EQ(mesh, before);
}

// A strip with a half twist has one side: no outside can be told.
TEST(Mesh, AMoebiusStripBecomesASheet) {
  Mesh mesh;
  mesh.materials = {Material{}};
  constexpr std::uint32_t n = 12;
  for (std::uint32_t i = 0; i < n; ++i) {
    const double a = 2 * 3.14159265358979 * i / n;
    for (const double s : {-0.3, 0.3})
      mesh.vertex_m.push_back({(1 + s * std::cos(a / 2)) * std::cos(a),
                               (1 + s * std::cos(a / 2)) * std::sin(a), s * std::sin(a / 2)});
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t a = 2 * i, b = 2 * i + 1;
    const std::uint32_t c = i + 1 < n ? a + 2 : 1, d = i + 1 < n ? b + 2 : 0;
    mesh.triangles.push_back({{a, c, d}});
    mesh.triangles.push_back({{a, d, b}});
  }
  const double one_side_m2 = surface_m2(mesh);
  EXPECT_EQ(repair(mesh, {"m", std::vector<std::uint32_t>(24, 1)}).size(), 1u);
  EXPECT_NEAR(surface_m2(mesh), 2 * one_side_m2, 1e-12);
}

}  // namespace
}  // namespace dmise
