#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/image.h"
#include "core/base/parallel.h"
#include "core/optics/blur/deposit.h"
#include "core/sky/sky_patch.h"
#include "sensors/render/scene_renderer.h"

namespace dmise {

/// Puts points and the sky on the plane by OpenGL instead of the analytic deposit. OpenGL is loaded
/// when it first draws.
class GlEvaluator {
 public:
  /// As `deposit`, for arcs that do not move. What it returns is computed, not measured.
  /// Throws `Error` for an arc that moves, or that `deposit` refuses, and where there is no OpenGL.
  std::vector<Deposited> add(std::span<const Arc> points, const PsfTable& psf,
                             const DepositView& view, Threads& threads);
  void add_sky(std::span<const SkyPatch> patches, ExpectedElectronImage& image);

  /// Describes the OpenGL that draws.
  std::string description();

 private:
  SceneRenderer& renderer();

  std::unique_ptr<SceneRenderer> renderer_;
  std::vector<ScenePoint> points_;
};

}  // namespace dmise
