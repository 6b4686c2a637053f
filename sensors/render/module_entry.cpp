#include <exception>

#include "sensors/render/gl_renderer.h"

/// Entry of the shared object. Null with the reason when there is no OpenGL here.
extern "C" dmise::Renderer* dmise_make_renderer(std::string& reason) {
  try {
    return dmise::make_gl_renderer().release();
  } catch (const std::exception& error) {
    reason = error.what();
    return nullptr;
  }
}
