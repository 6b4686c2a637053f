#include "sensors/pipeline/shape_layer.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/optics/projection.h"

namespace dmise {
namespace {

constexpr int longest_side_px = 2048;
constexpr int fine_side_px = 512;  // tiles below this are drawn finer than the camera's pixels
constexpr int finest = 4;
constexpr double widest_rad = 1.2;  // half angle of a tile

struct Local {};  // axes of the tile: z to the object

/// Axes about `direction` whose x is nearest to the camera's.
Rotation<CameraFrame, Local> local_axes(const Vec<CameraFrame>& direction) {
  const Vec<CameraFrame> aside =
      std::abs(direction.x) < 0.9 ? Vec<CameraFrame>{1, 0, 0} : Vec<CameraFrame>{0, 0, -1};
  const Vec<CameraFrame> y = unit(cross(direction, aside)), x = cross(y, direction);
  return {{{{x.x, y.x, direction.x}, {x.y, y.y, direction.y}, {x.z, y.z, direction.z}}}};
}

/// Light of snapshots on its way to the plane.
class ShapePainter {
 public:
  ShapePainter(const ObjectShapes& shapes, const Optics& optics, double exposure_s)
      : shapes_(shapes), optics_(optics), exposure_s_(exposure_s) {}

  void add(const ShapeSnapshot& snapshot) {
    const auto camera_from_local = local_axes(snapshot.direction);
    const auto local_from_body =
        camera_from_local.inverse() * snapshot.camera_from_gcrs * snapshot.pose.gcrs_from_body;
    Rotation<CameraFrame, Body> tile_from_body;  // the tile's axes, as those of its own camera
    tile_from_body.m = local_from_body.m;
    const Vec<CameraFrame> object_m{0, 0, snapshot.pose.range_m};
    const Mesh& mesh = snapshot.shape->light.mesh();
    const TileCamera camera = tile_around(mesh, tile_from_body, object_m, frame_of(snapshot));
    if (camera.columns == 0) return;
    const double au2 = snapshot.pose.sun_distance_au * snapshot.pose.sun_distance_au;
    const Tile tile = shapes_.renderer().draw(
        {.mesh = &mesh,
         .bands = {{&snapshot.shape->light.facets(),
                    shapes_.sun_photons() * snapshot.sunlit / au2}},
         .camera_from_body = tile_from_body,
         .object_m = object_m,
         .sources = {{snapshot.pose.to_sun, 1.0}},
         .camera = camera,
         .oversampling = std::clamp(fine_side_px / std::max(camera.columns, camera.rows), 4, 64)});
    for (int y = 0; y < tile.rows; ++y)
      for (int x = 0; x < tile.columns; ++x) {
        const std::size_t pixel = std::size_t(y) * std::size_t(tile.columns) + std::size_t(x);
        if (!(tile.coverage[pixel] > 0.0f)) continue;
        const double u = (x + camera.left) / camera.focal_px;
        const double v = (y + camera.top) / camera.focal_px;
        if (const auto place = project(optics_, camera_from_local * Vec<Local>{u, v, 1.0}))
          add_pixel(snapshot, *place, tile.radiance[pixel], tile.coverage[pixel],
                    1.0 / (camera.focal_px * camera.focal_px) / std::pow(1.0 + u * u + v * v, 1.5));
      }
  }

  Deposited finish(OpticsStage& stage, RateImage& image) {
    for (const auto& [pixel, share] : hidden_)
      image.pixels[pixel] *= std::max(0.0f, 1.0f - float(share));
    Deposited light;
    for (const auto& part : stage.add(arcs_, image)) light = light + part;
    return light;
  }

 private:
  /// Pixels of the tile's camera around the object, fine enough and not too many.
  TileCamera frame_of(const ShapeSnapshot& snapshot) const {
    const double ratio = snapshot.shape->radius_m / snapshot.pose.range_m;
    const double half_rad = ratio < 0.9 ? std::min(widest_rad, std::asin(ratio)) : widest_rad;
    const double side_px = 2.0 * std::tan(half_rad) * optics_.focal_length_px();
    const double scale = std::clamp(std::floor(fine_side_px / side_px), 1.0, double(finest)) *
                         std::min(1.0, longest_side_px / (side_px + 2.0));
    const double focal_px = optics_.focal_length_px() * scale;
    const int half = std::min(longest_side_px / 2, int(std::tan(half_rad) * focal_px) + 1);
    return {.focal_px = focal_px,
            .left = -half,
            .top = -half,
            .columns = 2 * half + 1,
            .rows = 2 * half + 1};
  }

  void add_pixel(const ShapeSnapshot& snapshot, const PixelPosition& place, float radiance,
                 float coverage, double solid_angle_sr) {
    const double signal_e =
        double(radiance) * solid_angle_sr * snapshot.electrons_per_photon_m2 * snapshot.seconds;
    if (signal_e > 0.0) arcs_.push_back({place, place, place, signal_e, 0.0});
    const int x = int(std::lround(place.x_px)), y = int(std::lround(place.y_px));
    if (x < 0 || y < 0 || x >= optics_.columns || y >= optics_.rows) return;
    const double pixel_sr = pixel_solid_angle_sr(optics_, place);
    if (pixel_sr > 0.0)
      hidden_[std::size_t(y) * std::size_t(optics_.columns) + std::size_t(x)] +=
          double(coverage) * solid_angle_sr / pixel_sr * snapshot.seconds / exposure_s_;
  }

  const ObjectShapes& shapes_;
  const Optics& optics_;
  double exposure_s_;
  std::vector<Arc> arcs_;
  std::map<std::size_t, double> hidden_;  // share of a pixel's light over the exposure
};

}  // namespace

Deposited draw_shape(const ObjectShapes& shapes, const std::vector<ShapeSnapshot>& snapshots,
                     const Optics& optics, OpticsStage& stage, RateImage& image) {
  double exposure_s = 0.0;
  for (const auto& snapshot : snapshots) exposure_s += snapshot.seconds;
  ShapePainter painter(shapes, optics, exposure_s);
  for (const auto& snapshot : snapshots) painter.add(snapshot);
  return painter.finish(stage, image);
}

}  // namespace dmise
