#pragma once
#include "sensors/render/gl.h"

namespace dmise {

/// A program of two shaders. Throws `Error` with the compiler's words.
unsigned link_program(const Gl& gl, const char* vertex_shader, const char* fragment_shader);

}  // namespace dmise
