#pragma once
#include "sensors/light/shape_layer.h"

namespace dmise {

/// Axes of the gnomonic camera that draws tiles.
struct TileAxes {};

/// What a frame sees of a resolved object, as pixels of a gnomonic camera.
struct ShapeWindow {
  Rotation<CameraFrame, TileAxes> camera_from_tile;
  Rotation<CameraFrame, Body> tile_from_body;  // the tile's axes as those of its own camera
  Vec<CameraFrame> object_m;                   // in those axes
  TileCamera camera;                           // no columns where the frame sees nothing of it
  double pixel_side_px = 1.0;  // side of a pixel of the tile, in pixels of the camera
};

/// `margin_px`: how far beside the frame the object still matters. For a gnomonic camera the tile's
/// pixels divide those of the camera, by four a side or so that a small object has 32, and by one
/// where it is large; for others they are about the object's direction and at least as fine.
ShapeWindow window_on(const Optics& optics, const Mesh& mesh, const ShapeSnapshot& snapshot,
                      double margin_px);

}  // namespace dmise
