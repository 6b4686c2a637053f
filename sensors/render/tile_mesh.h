#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "core/facets/facet_shadow.h"
#include "core/frames/vec.h"
#include "sensors/render/renderer.h"

namespace dmise {

// GLM types of the renderer's geometry are used only inside the renderer; outside, the frame of a
// vector is part of its type.
template <class F>
glm::dvec3 glm_of(const Vec<F>& v) {
  return {v.x, v.y, v.z};
}

/// GLM's matrices are arrays of columns.
template <class To, class From>
glm::dmat3 glm_of(const Rotation<To, From>& rotation) {
  glm::dmat3 columns;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) columns[j][i] = rotation.m[std::size_t(i)][std::size_t(j)];
  return columns;
}

/// One vertex for the shader. All members but `clip` and `view` are constant over the triangle.
struct TileVertex {
  glm::vec4 clip;      // in the whole tile; depth 1 at the nearest corner, 0 at the farthest
  glm::vec3 view;      // to the camera, any length
  glm::vec3 normal;    // unit, camera axes
  glm::vec4 diffuse;   // b^2 for up to three bands
  glm::vec4 specular;  // e^2 for up to three bands
  glm::vec4 emitted;   // up to three bands, then the exponent of Phong's lobe or -1
};
static_assert(sizeof(TileVertex) == 22 * sizeof(float));  // as OpenGL's attributes are declared

/// Additional vertex attributes of a facet with pictures: texture coordinates, and gradients of the
/// texture coordinates of the height map over the facet, times the height.
struct TextureVertex {
  glm::vec4 place;             // on the colours, on the heights
  glm::vec3 slope_u, slope_v;  // camera axes
};
static_assert(sizeof(TextureVertex) == 10 * sizeof(float));

/// The triangles of an object that face the camera, lit by one source. A partly shadowed facet is
/// drawn twice: whole and dark, as an underlay pushed back slightly to hide seams, and its lit
/// parts.
struct TileMesh {
  std::vector<TileVertex> vertices;
  struct Bounds {
    float x0, y0, x1, y1;  // corners in the tile [px], pixel centres are integers
  };
  std::vector<Bounds> bounds;           // one per triangle, of three vertices
  std::vector<TextureVertex> texture;   // as `vertices`; empty when no material has a picture
  std::vector<std::uint32_t> material;  // one per triangle, as `texture`
  std::size_t underlays = 0;            // the first triangles

  /// Shining parts of facets with too few samples: drawn dark, their light is added to the pixel of
  /// their centre.
  struct Speck {
    glm::vec2 place_px;  // where it is in the tile
    glm::vec3 light;     // radiance x pixels for up to three bands
  };
  std::vector<Speck> specks;
};

/// Lit parts of each facet; no pieces: all of it.
struct LitPieces {
  std::vector<std::uint32_t> begin;  // facets + 1, into `pieces`
  std::vector<FacetPiece> pieces;
  enum State : char { dark, lit, partly };
  std::vector<State> state;   // one per facet
  bool only_visible = false;  // without parts hidden from the camera
  bool convex = false;        // nothing hides a facet that faces the camera
};
/// `viewer`, if not null: parts invisible from that direction are removed, so that the light of
/// nearly hidden facets does not depend on single samples.
LitPieces lit_pieces(const Mesh& mesh, const Vec<Body>& to_source, bool convex,
                     const FacetShadow* viewer = nullptr);

/// `first_band`: index of the first of up to three bands. `with_emission`: add thermal emission.
TileMesh tile_mesh(const TileScene& scene, const LightSource& source, const LitPieces& lit,
                   std::size_t first_band, bool with_emission);

}  // namespace dmise
