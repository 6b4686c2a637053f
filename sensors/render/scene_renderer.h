#pragma once
#include <cstddef>
#include <span>
#include <string>

#include "core/sky/sky_patch.h"

// Draws whole scenes by OpenGL: point sources and sky, behind an interface like renderer.h.
namespace dmise {

/// Light around a position of a plane; cell centres are integers.
struct ScenePoint {
  double x = 0.0, y = 0.0;
  double light = 0.0;  // [e-], >= 0
};

/// Target of drawing: rows x columns floats, `stride` floats per row.
struct ScenePlane {
  float* cells = nullptr;
  int columns = 0, rows = 0;
  std::ptrdiff_t stride = 0;
};

/// Draws on planes of any size in pieces of 512 x 512 cells of 32-bit floats, with the same bytes
/// at every call.
class SceneRenderer {
 public:
  virtual ~SceneRenderer() = default;
  /// Description for the log, as of `Renderer`.
  virtual std::string description() const = 0;
  /// Adds points, each a Gaussian of `sigma` cells (0.02..500) integrated over the cells. Points
  /// are blended in the given order, in single precision: with n of them on a cell its light is
  /// accurate to n 3e-8. Points must be finite.
  virtual void add_points(std::span<const ScenePoint> points, double sigma,
                          const ScenePlane& plane) = 0;
  /// Adds patches; a later one covers earlier ones.
  virtual void add_patches(std::span<const SkyPatch> patches, const ScenePlane& plane) = 0;
};

}  // namespace dmise
