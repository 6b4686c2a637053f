#pragma once
#include <memory>
#include <string>
#include <vector>

#include "core/facets/facet_light.h"
#include "core/frames/vec.h"
#include "core/materials/mesh.h"

// Pictures of objects near enough to have a shape. OpenGL lives behind this interface, in a shared
// object that is loaded when a plan first needs it (render_module.h).
namespace dmise {

/// A rectangle of a gnomonic camera's pixels. Pixel (0, 0) of the tile is the camera's (left, top).
struct TileCamera {
  double focal_px = 1.0;
  double principal_x_px = 0.0, principal_y_px = 0.0;  // of the camera; pixel centres are whole
  int left = 0, top = 0;
  int columns = 0, rows = 0;
};

/// Light and surface of a mesh in one spectral band.
struct TileBand {
  const FacetSet* facets = nullptr;  // of the mesh
  double sun_irradiance = 1.0;       // at the object, in the unit the radiance shall have times sr
};

/// One object before one camera.
struct TileScene {
  const Mesh* mesh = nullptr;
  std::vector<TileBand> bands;
  Rotation<CameraFrame, Body> camera_from_body;
  Vec<CameraFrame> object_m;         // origin of the body's axes, from the camera
  std::vector<LightSource> sources;  // the Sun first, each with its share of the irradiance
  TileCamera camera;
  int oversampling = 4;  // samples per pixel and axis, 1..64
};

/// Radiance of an object, mean over each pixel (what lies beside the object counts as 0).
struct Tile {
  int columns = 0, rows = 0, bands = 0;
  std::vector<float> radiance;  // rows x columns x bands, row-major
  std::vector<float> coverage;  // rows x columns: share of the pixel that the object hides, 0..1

  float at(int x, int y, int band) const {
    return radiance[(std::size_t(y) * std::size_t(columns) + std::size_t(x)) * std::size_t(bands) +
                    std::size_t(band)];
  }
};

class Renderer {
 public:
  virtual ~Renderer() = default;
  /// What draws: "OSMesa, llvmpipe (...)" or "EGL, NVIDIA ...", for the log.
  virtual std::string description() const = 0;
  /// Throws `Error` for a camera inside the object's bounding box, for no or more than 16 bands,
  /// and for a tile without pixels or of more than 16384 a side.
  virtual Tile draw(const TileScene& scene) = 0;
};

/// Pixels that the object may touch, cut to `frame`; no columns when there are none. An object that
/// reaches behind the camera's image plane may touch all of them.
TileCamera tile_around(const Mesh& mesh, const Rotation<CameraFrame, Body>& camera_from_body,
                       const Vec<CameraFrame>& object_m, const TileCamera& frame);

/// Throws `Error` naming it when the camera is inside the bounding box of the mesh.
void check_outside(const Mesh& mesh, const Rotation<CameraFrame, Body>& camera_from_body,
                   const Vec<CameraFrame>& object_m);

}  // namespace dmise
