#pragma once
#include <cstdint>
#include <vector>

#include "core/facets/facet_shadow.h"
#include "sensors/render/glm_types.h"
#include "sensors/render/renderer.h"

namespace dmise {

/// One corner as the shader takes it. All but `clip` and `view` is the same for the whole triangle.
struct TileVertex {
  glm::vec4 clip;      // in the whole tile; depth 1 at the nearest corner, 0 at the farthest
  glm::vec3 view;      // to the camera, any length
  glm::vec3 normal;    // unit, camera axes
  glm::vec4 diffuse;   // of up to three bands, b^2
  glm::vec4 specular;  // of up to three bands, e^2
  glm::vec4 emitted;   // of up to three bands, exponent of Phong's lobe or -1
};
static_assert(sizeof(TileVertex) == 22 * sizeof(float));  // as OpenGL's attributes are declared

/// What a corner of a facet with pictures has beside: where it is on them, and how the place on the
/// height map grows over the facet, times the height.
struct TextureVertex {
  glm::vec4 place;             // on the colours, on the heights
  glm::vec3 slope_u, slope_v;  // camera axes
};
static_assert(sizeof(TextureVertex) == 10 * sizeof(float));

/// The triangles of an object that face the camera, lit by one source. A facet that is partly in
/// shadow comes twice: whole and dark, as an underlay to be pushed back a little so that no seam
/// shows through, and in its lit parts.
struct TileMesh {
  std::vector<TileVertex> vertices;
  struct Bounds {
    float x0, y0, x1, y1;  // of the tile [px], pixel centres are whole
  };
  std::vector<Bounds> bounds;           // one a triangle, of three vertices
  std::vector<TextureVertex> texture;   // as `vertices`; empty when no material has a picture
  std::vector<std::uint32_t> material;  // one a triangle, as `texture`
  std::size_t underlays = 0;            // the first triangles

  /// Lit parts of facets that have too few samples to be drawn by them: drawn dark, their light
  /// goes to the pixel of their middle.
  struct Speck {
    glm::vec2 place_px;  // of the tile
    glm::vec3 light;     // of up to three bands, radiance x pixels
  };
  std::vector<Speck> specks;
};

/// What of each facet a source reaches; no pieces: all of it.
struct LitPieces {
  std::vector<std::uint32_t> begin;  // facets + 1, into `pieces`
  std::vector<FacetPiece> pieces;
  enum State : char { dark, lit, partly };
  std::vector<State> state;   // one a facet
  bool only_visible = false;  // what other facets hide from the camera is left out
};
/// `viewer`, if not null: what that direction does not see is left out, so that the light of what
/// is all but hidden does not hang on single samples.
LitPieces lit_pieces(const Mesh& mesh, const Vec<Body>& to_source, bool convex,
                     const FacetShadow* viewer = nullptr);

/// `first_band`: up to three bands from there on. `with_emission`: add what the facets radiate.
TileMesh tile_mesh(const TileScene& scene, const LightSource& source, const LitPieces& lit,
                   std::size_t first_band, bool with_emission);

}  // namespace dmise
