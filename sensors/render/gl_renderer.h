#pragma once
#include <memory>

#include "sensors/render/renderer.h"
#include "sensors/render/scene_renderer.h"

namespace dmise {

/// The renderers with the best available OpenGL. Throw `Error` without one.
std::unique_ptr<Renderer> make_gl_renderer();
std::unique_ptr<SceneRenderer> make_gl_scene_renderer();

}  // namespace dmise
