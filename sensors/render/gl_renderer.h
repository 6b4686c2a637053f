#pragma once
#include <memory>

#include "sensors/render/renderer.h"

namespace dmise {

/// The renderer on the best OpenGL that this machine has. Throws `Error` without one.
std::unique_ptr<Renderer> make_gl_renderer();

}  // namespace dmise
