#pragma once
#include "sensors/render/gl/gl.h"

namespace dmise {

/// Links a program of two shaders, preceded by "#version 450 core" and `definition`, if not null.
/// Throws `Error` with the compiler's message.
unsigned link_program(const Gl& gl, const char* vertex_shader, const char* fragment_shader,
                      const char* definition = nullptr);

}  // namespace dmise
