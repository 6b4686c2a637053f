#include "sensors/render/gl/gl_context.h"
#include "sensors/render/gl/gl.h"

#include <cstdlib>
#include <string_view>

#include "core/base/error.h"
#include "core/base/nearest_name.h"
#include "core/base/printable.h"

namespace dmise {

Gl load_gl(GlContext& context) {
  Gl gl;
#define DMISE_GL_LOAD(type, name)                                \
  gl.name = reinterpret_cast<type>(context.address("gl" #name)); \
  if (!gl.name) throw Error("OpenGL has no function gl" #name);
  DMISE_GL_FUNCTIONS(DMISE_GL_LOAD)
#undef DMISE_GL_LOAD
  return gl;
}

std::string description_of(const Gl& gl, const GlContext& context) {
  const auto text = [&](unsigned name) {
    return std::string(reinterpret_cast<const char*>(gl.GetString(name)));
  };
  return context.name() + ", " + text(GL_RENDERER) + ", OpenGL " + text(GL_VERSION);
}

std::unique_ptr<GlContext> open_gl() {
  const char* text = std::getenv("DMISE_RENDERER");
  const std::string_view wish = text ? text : "";
  if (wish == "osmesa") return open_osmesa();
  if (wish == "egl") {
    if (auto context = open_egl(true)) return context;
    throw Error("DMISE_RENDERER=egl: no OpenGL 4.5 through EGL");
  }
  if (!wish.empty())
    throw Error("DMISE_RENDERER: must be osmesa or egl" + did_you_mean(wish, {"osmesa", "egl"}) +
                ", got " + printable(wish));
  if (auto context = open_egl()) return context;
  return open_osmesa();
}

}  // namespace dmise
