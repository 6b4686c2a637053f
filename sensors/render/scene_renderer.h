#pragma once
#include <cstddef>
#include <span>
#include <string>

#include "core/sky/sky_patch.h"

// Whole scenes by OpenGL: points of light and the sky. Behind this interface, like renderer.h.
namespace dmise {

/// Light that falls about one place of a plane; the centres of its cells are whole.
struct ScenePoint {
  double x = 0.0, y = 0.0;
  double light = 0.0;  // [e-], >= 0
};

/// A plane of cells to draw on: rows x columns floats, `stride` from row to row.
struct ScenePlane {
  float* cells = nullptr;
  int columns = 0, rows = 0;
  std::ptrdiff_t stride = 0;
};

/// Draws on planes of any size in pieces of 512 x 512 cells of 32-bit floats, the same bytes at
/// every call.
class SceneRenderer {
 public:
  virtual ~SceneRenderer() = default;
  /// As of `Renderer`.
  virtual std::string description() const = 0;
  /// Adds points, each a Gaussian of `sigma` cells (0.02..500) integrated over the cells. Points
  /// are blended in the order given, in single precision: with n of them on a cell its light is
  /// right to n 3e-8. Points must be finite.
  virtual void add_points(std::span<const ScenePoint> points, double sigma,
                          const ScenePlane& plane) = 0;
  /// Adds patches, of which a later one covers what an earlier one drew.
  virtual void add_patches(std::span<const SkyPatch> patches, const ScenePlane& plane) = 0;
};

}  // namespace dmise
