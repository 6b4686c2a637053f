#pragma once
#include <memory>

#include "sensors/render/renderer.h"

namespace dmise {

/// The renderer with the best available OpenGL. Throws `Error` without one.
std::unique_ptr<Renderer> make_gl_renderer();

}  // namespace dmise
