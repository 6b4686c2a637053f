#pragma once
#include <memory>

#include "sensors/render/renderer.h"
#include "sensors/render/scene_renderer.h"

namespace dmise {

/// Loads the renderer's shared object (lib/libdmise_render.so beside the programs' bin, or the path
/// in `DMISE_RENDER_MODULE`) at the first call, and creates a renderer. Throws `Error` with the
/// reason if it cannot be loaded.
std::unique_ptr<Renderer> load_renderer();
std::unique_ptr<SceneRenderer> load_scene_renderer();

}  // namespace dmise
