#include "sensors/scene/gl_evaluator.h"

#include <cmath>

#include "core/base/error.h"
#include "sensors/render/render_module.h"

namespace dmise {
namespace {

ScenePoint point_of(const Arc& arc, std::size_t index) {
  const PixelPosition at = arc.middle;
  if (!(std::abs(at.x_px) < 1e15 && std::abs(at.y_px) < 1e15 && arc.signal_e >= 0.0 &&
        arc.signal_e < 1e30))
    throw Error("scene: point " + std::to_string(index) + " is not finite or has negative light");
  if (!arc.is_point()) throw Error("scene: point " + std::to_string(index) + " moves");
  return {at.x_px, at.y_px, arc.signal_e};
}

}  // namespace

SceneRenderer& GlEvaluator::renderer() {
  if (!renderer_) renderer_ = load_scene_renderer();
  return *renderer_;
}

std::string GlEvaluator::description() { return renderer().description(); }

std::vector<Deposited> GlEvaluator::add(std::span<const Arc> points, const PsfTable& psf,
                                        const DepositView& view, Threads& threads) {
  points_.clear();
  for (std::size_t i = 0; i < points.size(); ++i) points_.push_back(point_of(points[i], i));
  renderer().add_points(points_, psf.sigma_px, {view.pixels, view.columns, view.rows, view.stride});
  std::vector<Deposited> result(points.size());
  threads.for_ranges(points.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) result[i] = deposited_in_frame(points[i], psf, view);
  });
  return result;
}

void GlEvaluator::add_sky(std::span<const SkyPatch> patches, ExpectedElectronImage& image) {
  renderer().add_patches(patches, {image.pixels.data(), image.columns, image.rows, image.columns});
}

}  // namespace dmise
