#include "sensors/render/gl/gl_program.h"

#include <array>
#include <string>

#include "core/base/error.h"

namespace dmise {
namespace {

unsigned compiled(const Gl& gl, unsigned kind, const char* text, const char* definition) {
  const unsigned shader = gl.CreateShader(kind);
  const std::string define = definition ? "#define " + std::string(definition) + "\n" : "";
  const std::array parts{"#version 450 core\n", define.c_str(), text};
  gl.ShaderSource(shader, int(parts.size()), parts.data(), nullptr);
  gl.CompileShader(shader);
  int ok = 0;
  gl.GetShaderiv(shader, GL_COMPILE_STATUS, &ok);
  if (!ok) {
    char log[1024] = "";
    gl.GetShaderInfoLog(shader, sizeof log, nullptr, log);
    throw Error(std::string("shader: ") + log);
  }
  return shader;
}

}  // namespace

unsigned link_program(const Gl& gl, const char* vertex_shader, const char* fragment_shader,
                      const char* definition) {
  const unsigned program = gl.CreateProgram();
  for (const unsigned shader : {compiled(gl, GL_VERTEX_SHADER, vertex_shader, definition),
                                compiled(gl, GL_FRAGMENT_SHADER, fragment_shader, definition)}) {
    gl.AttachShader(program, shader);
    gl.DeleteShader(shader);
  }
  gl.LinkProgram(program);
  int ok = 0;
  gl.GetProgramiv(program, GL_LINK_STATUS, &ok);
  if (!ok) throw Error("shaders do not link");
  return program;
}

}  // namespace dmise
