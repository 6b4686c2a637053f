#include "sensors/render/render_module.h"

#include "core/base/module.h"

namespace dmise {
namespace {

constexpr Module module{"render", "DMISE_RENDER_MODULE"};

}  // namespace

std::unique_ptr<Renderer> load_renderer() {
  return std::unique_ptr<Renderer>(
      static_cast<Renderer*>(made_by_module(module, "dmise_make_renderer")));
}

std::unique_ptr<SceneRenderer> load_scene_renderer() {
  return std::unique_ptr<SceneRenderer>(
      static_cast<SceneRenderer*>(made_by_module(module, "dmise_make_scene_renderer")));
}

}  // namespace dmise
