#include "sensors/light/shape_layer.h"

#include <algorithm>
#include <cmath>

#include "core/effects/frame_effects.h"
#include "core/optics/projection.h"
#include "sensors/light/shape_window.h"

namespace dmise {
namespace {

constexpr int piece_px = 512;  // longest side of a tile
constexpr std::size_t arcs_at_once = 1 << 16;
constexpr int max_cover_steps = 1024;  // along one arc

/// Farthest that a sweep leads from its middle.
double reach_px(const std::vector<Arc>& sweep) {
  double reach = 0.0;
  for (const Arc& arc : sweep) {
    const ArcExtent e = extent(arc);
    reach = std::max({reach, -e.left, -e.top, e.right, e.bottom});
  }
  return reach;
}

/// Light of snapshots on its way to the plane.
class ShapePainter {
 public:
  ShapePainter(const View& view, const ObjectShapes& shapes, double defocus_m, OpticsStage& stage,
               OcclusionMask& mask, ExpectedElectronImage& image)
      : view_(view),
        shapes_(shapes),
        optics_(view.sensor().camera.optics),
        occludes_(acts<Occlusion>(view.sensor().effects, view.scene())),
        defocus_m_(defocus_m),
        stage_(stage),
        mask_(mask),
        image_(image) {}

  void add(const ShapeSnapshot& snapshot) {
    if (!(snapshot.photons_per_s_m2 > 0.0)) add_point(snapshot);
    const auto light = snapshot.shape->light(snapshot.pose.to_sun);
    const ShapeWindow window = window_on(optics_, light->mesh(), snapshot,
                                         stage_.reach_px(defocus_m_) + reach_px(snapshot.sweep));
    const TileCamera& whole = window.camera;
    for (int top = 0; top < whole.rows; top += piece_px)
      for (int left = 0; left < whole.columns; left += piece_px) {
        TileCamera piece = whole;
        piece.left += left;
        piece.top += top;
        piece.columns = std::min(piece_px, whole.columns - left);
        piece.rows = std::min(piece_px, whole.rows - top);
        add_piece(snapshot, *light, window, piece);
      }
  }

  Deposited finish() {
    hand_over();
    mask_.close();
    return light_;
  }

 private:
  void add_piece(const ShapeSnapshot& snapshot, const FacetLight& light, const ShapeWindow& window,
                 const TileCamera& camera) {
    const double au2 = snapshot.pose.sun_distance_au * snapshot.pose.sun_distance_au;
    std::vector<LightSource> sources{{snapshot.pose.to_sun, snapshot.sunlit}};
    const auto& secondary = snapshot.pose.secondary;
    sources.insert(sources.end(), secondary.begin(), secondary.end());
    const Tile tile = shapes_.renderer().draw(
        {.mesh = &light.mesh(),
         .bands = {{&light.facets(), shapes_.sun_photons() / au2}},
         .camera_from_body = window.tile_from_body,
         .object_m = window.object_m,
         .sources = std::move(sources),
         .camera = camera,
         .oversampling = std::clamp(piece_px / std::max(camera.columns, camera.rows), 4, 64)});
    const auto middle = project(optics_, snapshot.direction);
    const double at_middle = middle ? view_.illumination(*middle) : 1.0;
    for (int y = 0; y < tile.rows; ++y)
      for (int x = 0; x < tile.columns; ++x) {
        const std::size_t pixel = std::size_t(y) * std::size_t(tile.columns) + std::size_t(x);
        // Light of facets thinner than the samples may be where nothing is covered.
        if (!(tile.coverage[pixel] > 0.0f || tile.radiance[pixel] > 0.0f)) continue;
        const double u = (x + camera.left - camera.principal_x_px) / camera.focal_px;
        const double v = (y + camera.top - camera.principal_y_px) / camera.focal_px;
        const auto place = project(optics_, window.camera_from_tile * Vec<TileAxes>{u, v, 1.0});
        if (!place) continue;
        const double solid_angle_sr =
            1.0 / (camera.focal_px * camera.focal_px) / std::pow(1.0 + u * u + v * v, 1.5);
        if (tile.coverage[pixel] > 0.0f)
          cover(snapshot, *place, window.pixel_side_px,
                tile.coverage[pixel] * solid_angle_sr / pixel_solid_angle_sr(optics_, *place));
        if (snapshot.photons_per_s_m2 > 0.0)
          add_light(snapshot, *place,
                    tile.radiance[pixel] * solid_angle_sr / snapshot.photons_per_s_m2 *
                        view_.illumination(*place) / at_middle);
      }
  }

  /// Light of another moment than the pose's, which is dark.
  void add_point(const ShapeSnapshot& snapshot) {
    if (const auto middle = project(optics_, snapshot.direction)) add_light(snapshot, *middle, 1.0);
  }

  /// `share`: of the object's light.
  void add_light(const ShapeSnapshot& snapshot, const PixelPosition& at, double share) {
    for (const Arc& way : snapshot.sweep) {
      const double signal_e = share * way.signal_e;
      if (!(signal_e > 0.0)) continue;
      const Arc arc{at + way.start, at + way.middle, at + way.end, signal_e, way.tilt};
      if (mask_.empty()) {
        arcs_.push_back(arc);
      } else {
        const auto free = mask_.past({&arc, 1});
        arcs_.insert(arcs_.end(), free.begin(), free.end());
      }
    }
    if (arcs_.size() >= arcs_at_once) hand_over();
  }

  void cover(const ShapeSnapshot& snapshot, const PixelPosition& at, double side_px,
             double hidden_px) {
    if (!occludes_) return;
    const double share = snapshot.share / double(snapshot.sweep.size());
    for (const Arc& way : snapshot.sweep) {
      const int steps =
          int(std::clamp(std::ceil(2.0 * length_px(way)), 1.0, double(max_cover_steps)));
      for (int i = 0; i < steps; ++i)
        mask_.cover(at + place(way, (i + 0.5) / steps), side_px, hidden_px * share / steps);
    }
  }

  void hand_over() {
    light_ = light_ + stage_.add(arcs_, defocus_m_, image_);
    arcs_.clear();
  }

  const View& view_;
  const ObjectShapes& shapes_;
  const Optics& optics_;
  const bool occludes_;
  const double defocus_m_;
  OpticsStage& stage_;
  OcclusionMask& mask_;
  ExpectedElectronImage& image_;
  std::vector<Arc> arcs_;
  Deposited light_;
};

}  // namespace

Deposited draw_shape(const View& view, const ObjectShapes& shapes,
                     const std::vector<ShapeSnapshot>& snapshots, double defocus_m,
                     OpticsStage& stage, OcclusionMask& mask, ExpectedElectronImage& image) {
  ShapePainter painter(view, shapes, defocus_m, stage, mask, image);
  for (const auto& snapshot : snapshots) painter.add(snapshot);
  return painter.finish();
}

}  // namespace dmise
