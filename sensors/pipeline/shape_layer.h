#pragma once
#include <vector>

#include "core/base/image.h"
#include "sensors/pipeline/object_shapes.h"
#include "sensors/pipeline/optics_stage.h"

namespace dmise {

/// One snapshot of a resolved object.
struct ShapeSnapshot {
  const ObjectShape* shape = nullptr;
  ShapePose pose;
  Rotation<CameraFrame, Gcrs> camera_from_gcrs;
  Vec<CameraFrame> direction;  // apparent, unit
  double sunlit = 1.0;
  double electrons_per_photon_m2 = 0.0;  // of the whole way to the detector; 0 when hidden
  double seconds = 0.0;                  // that it stands for
};

/// Draws an object with its shape: for each snapshot of the exposure a tile about its direction,
/// finer than the camera's pixels where it is small, each of whose pixels is put on the plane
/// through the camera's own projection, as a point of its light. What was on the plane before is
/// behind the object and dimmed by its coverage (blur aside). Throws `Error` for a camera inside
/// the bounding box.
Deposited draw_shape(const ObjectShapes& shapes, const std::vector<ShapeSnapshot>& snapshots,
                     const Optics& optics, OpticsStage& stage, RateImage& image);

}  // namespace dmise
