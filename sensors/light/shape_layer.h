#pragma once
#include <vector>

#include "core/base/image.h"
#include "sensors/objects/object_shapes.h"
#include "sensors/scene/occlusion_mask.h"
#include "sensors/scene/optics_stage.h"

namespace dmise {

/// A resolved object over a part of the exposure in which it keeps its pose while it moves.
struct ShapeSnapshot {
  const ObjectShape* shape = nullptr;
  ShapePose pose;
  Rotation<CameraFrame, Gcrs> camera_from_gcrs;
  Vec<CameraFrame> direction;     // apparent, unit, of its middle in that pose
  double sunlit = 1.0;            // share of sunlight on it in that pose
  double photons_per_s_m2 = 0.0;  // all facets in that pose, as pictures show them
  /// Way of its middle from where `direction` is [px], in arcs of equal time, with the light of the
  /// whole object at the detector.
  std::vector<Arc> sweep;
  double share = 1.0;  // part of the exposure
};

/// Draws an object with its shape: for each snapshot tiles of what the frame sees of it, finer than
/// the camera's pixels where it is small, each of whose pixels is put on the plane through the
/// camera's own projection and swept along. The sweep gives the light, the pose its distribution;
/// what nearer objects hide by the mask is left out, and the object is added to it.
/// All of it is in the defocus of its middle. Memory is bounded by the frame. Throws `Error` for a
/// camera inside the bounding box.
Deposited draw_shape(const View& view, const ObjectShapes& shapes,
                     const std::vector<ShapeSnapshot>& snapshots, double defocus_m,
                     OpticsStage& stage, OcclusionMask& mask, ExpectedElectronImage& image);

}  // namespace dmise
