#pragma once
#include <string>
#include <vector>

#include "core/config/objects/material_config.h"
#include "core/materials/obj_file.h"
#include "core/materials/shapes.h"
#include "sensors/render/render_module.h"
#include "tests/support/directions.h"

namespace dmise {

/// One renderer for all tests of a program.
inline Renderer& renderer() {
  static const std::unique_ptr<Renderer> one = load_renderer();
  return *one;
}

inline const MaterialLibrary& library() {
  static const MaterialLibrary all(DMISE_SOURCE_DIR "/launch/materials/library.yaml");
  return all;
}
inline Material named(const char* name) { return *library().find(name); }

struct NamedMesh {
  std::string name;
  Mesh mesh;
};

inline Mesh inspector() {
  return load_obj(DMISE_SOURCE_DIR "/launch/models/inspector.obj",
                  [](std::string_view name) { return library().find(name); })
      .mesh;
}

/// Every model that is shipped: those by parameters with materials of the library, and the files.
inline std::vector<NamedMesh> shipped_shapes() {
  return {{"box", box({1.2, 0.8, 2.0}, named("kapton"))},
          {"plate", plate(2.0, 3.0, named("silicon-cell"), named("white-paint"))},
          {"cylinder", cylinder(0.6, 3.0, 64, named("aluminium"))},
          {"sphere", sphere(1.0, 5000, named("white-paint"))},
          {"box-wing", box_wing({}, named("kapton"), named("silicon-cell"), named("white-paint"))},
          // About its middle, so that it fills the picture.
          {"starlink", moved(starlink_like(named("starlink-chassis"), named("starlink-array"),
                                           named("starlink-array")),
                             {0, 0, 4.1})},
          {"inspector", inspector()}};
}

/// Axes of the camera from axes of the body: looks along `view` (unit, body axes), turned by
/// `roll`.
inline Rotation<CameraFrame, Body> looking_along(const Vec<Body>& view, double roll_rad) {
  const Vec<Body> away = std::abs(view.x) < 0.6 ? Vec<Body>{1, 0, 0} : Vec<Body>{0, 1, 0};
  const Vec<Body> u = unit(cross(away, view)), v = cross(view, u);
  const Vec<Body> x = u * std::cos(roll_rad) + v * std::sin(roll_rad);
  const Vec<Body> y = v * std::cos(roll_rad) - u * std::sin(roll_rad);
  return {{{{x.x, x.y, x.z}, {y.x, y.y, y.z}, {view.x, view.y, view.z}}}};
}

/// A camera that sees a mesh of radius `size_m` around its boresight across about `pixels`.
inline TileCamera camera_around(double size_m, double range_m, int pixels) {
  return {.focal_px = 0.5 * pixels * range_m / size_m,
          .principal_x_px = (pixels - 1) / 2.0,
          .principal_y_px = (pixels - 1) / 2.0,
          .columns = pixels,
          .rows = pixels};
}

/// Photons/s/m2 of the Sun in V; what an object radiates there by its warmth is nothing beside it.
constexpr double sun_photons = 4.5e20;
/// Far against the size of the shapes: light to the camera is parallel.
constexpr double far_m = 1e6;

inline Tile draw(const FacetLight& object, const Vec<Body>& to_sun, const Vec<Body>& to_viewer,
                 const TileCamera& camera, double roll_rad, int oversampling,
                 double distance_m = far_m) {
  return renderer().draw({.mesh = &object.mesh(),
                          .bands = {{&object.facets(), sun_photons}},
                          .camera_from_body = looking_along(-to_viewer, roll_rad),
                          .object_m = {0, 0, distance_m},
                          .sources = {{to_sun, 1.0}},
                          .camera = camera,
                          .oversampling = oversampling});
}

/// Sum over the pixels of radiance x solid angle.
inline double flux(const Tile& tile, const TileCamera& camera, int band = 0) {
  double sum = 0;
  for (int y = 0; y < tile.rows; ++y)
    for (int x = 0; x < tile.columns; ++x) {
      const double u = (x + camera.left - camera.principal_x_px) / camera.focal_px;
      const double v = (y + camera.top - camera.principal_y_px) / camera.focal_px;
      sum += tile.at(x, y, band) / std::pow(1 + u * u + v * v, 1.5);
    }
  return sum / (camera.focal_px * camera.focal_px);
}

}  // namespace dmise
