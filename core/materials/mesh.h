#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/materials/material.h"
#include "core/materials/texture.h"
#include "core/orbit/attitude.h"

namespace dmise {

/// A surface of flat triangles in the axes of its body. The visible and lit side is the one from
/// which the corners run counter-clockwise.
struct Mesh {
  struct Triangle {
    std::array<std::uint32_t, 3> corner;
    std::uint32_t material = 0;           // index into `materials`
    std::array<TexturePlace, 3> place{};  // where the corners are on the pictures of the material
    bool panel = false;                   // it belongs to the part that turns (panel.h)

    void turn_over() {
      std::swap(corner[1], corner[2]);
      std::swap(place[1], place[2]);
    }

    bool operator==(const Triangle&) const = default;
  };

  std::vector<Vec<Body>> vertex_m;
  std::vector<Triangle> triangles;
  std::vector<Material> materials;

  bool operator==(const Mesh&) const = default;
};

/// Twice the area of a triangle along its normal [m2].
Vec<Body> double_area_m2(const Mesh& mesh, const Mesh::Triangle& triangle);

/// Sum of the areas of all triangles [m2].
double surface_m2(const Mesh& mesh);

/// Greatest distance of a vertex from the origin of the body's axes [m].
double radius_m(const Mesh& mesh);

/// Whether every vertex lies behind every facet's plane, to 1e-9 of the size, so that no facet
/// hides or shadows another.
bool is_convex(const Mesh& mesh);

/// The triangles of both; equal materials are merged.
Mesh merged(const Mesh& a, const Mesh& b);

Mesh moved(Mesh mesh, const Vec<Body>& by_m);
Mesh scaled(Mesh mesh, double factor);
/// The mesh with its sides exchanged, for the back of a sheet.
Mesh reversed(Mesh mesh);

}  // namespace dmise
