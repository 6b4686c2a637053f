#pragma once
#include <memory>

#include "sensors/render/scene_renderer.h"

namespace dmise {

/// The scene renderer with the best available OpenGL. Throws `Error` without one.
std::unique_ptr<SceneRenderer> make_gl_scene_renderer();

}  // namespace dmise
