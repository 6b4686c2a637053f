#pragma once
#include <memory>
#include <string>
#include <vector>

#include "core/facets/facet_light.h"
#include "core/frames/vec.h"
#include "core/materials/mesh.h"

// Draws resolved objects. OpenGL is hidden behind this interface, in a shared object that is loaded
// at first use (render_module.h).
namespace dmise {

/// A rectangle of pixels of a gnomonic camera. Pixel (0, 0) of the tile is the camera's (left,
/// top).
struct TileCamera {
  double focal_px = 1.0;
  double principal_x_px = 0.0, principal_y_px = 0.0;  // in the camera; pixel centres are integers
  int left = 0, top = 0;
  int columns = 0, rows = 0;
};

/// Light and reflectance of a mesh in one spectral band.
struct TileBand {
  const FacetSet* facets = nullptr;  // facets of the mesh
  double sun_irradiance = 1.0;       // at the object, in the unit of radiance times sr
};

/// One object in front of one camera.
struct TileScene {
  const Mesh* mesh = nullptr;
  std::vector<TileBand> bands;
  Rotation<CameraFrame, Body> camera_from_body;
  Vec<CameraFrame> object_m;         // origin of the body's axes, from the camera
  std::vector<LightSource> sources;  // the Sun first; shares of the irradiance
  TileCamera camera;
  int oversampling = 4;  // samples per pixel and axis, 1..64
};

/// Radiance of an object, averaged over each pixel (0 outside the object).
struct Tile {
  int columns = 0, rows = 0, bands = 0;
  std::vector<float> radiance;  // rows x columns x bands, row-major
  std::vector<float> coverage;  // rows x columns: fraction of the pixel covered, 0..1

  float at(int x, int y, int band) const {
    return radiance[(std::size_t(y) * std::size_t(columns) + std::size_t(x)) * std::size_t(bands) +
                    std::size_t(band)];
  }
};

class Renderer {
 public:
  virtual ~Renderer() = default;
  /// Description for the log: "OSMesa, llvmpipe (...)" or "EGL, NVIDIA ...".
  virtual std::string description() const = 0;
  /// Throws `Error` for a camera inside the object's bounding box, for no or more than 16 bands,
  /// and for a tile without pixels or with more than 16384 per side.
  virtual Tile draw(const TileScene& scene) = 0;
};

/// Pixels that the object may cover, clipped to `frame`; no columns if there are none. An object
/// that extends behind the camera's image plane may cover all of them.
TileCamera tile_around(const Mesh& mesh, const Rotation<CameraFrame, Body>& camera_from_body,
                       const Vec<CameraFrame>& object_m, const TileCamera& frame);

/// Distance of the camera from the bounding box of the mesh; 0 inside.
double distance_from_box_m(const Mesh& mesh, const Rotation<CameraFrame, Body>& camera_from_body,
                           const Vec<CameraFrame>& object_m);

/// Throws `Error` naming it if the camera is inside the bounding box of the mesh.
void check_outside(const Mesh& mesh, const Rotation<CameraFrame, Body>& camera_from_body,
                   const Vec<CameraFrame>& object_m);

}  // namespace dmise
