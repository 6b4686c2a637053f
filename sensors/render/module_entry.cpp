#include <exception>

#include "sensors/render/gl_renderer.h"

namespace {

template <class T>
T* made(std::unique_ptr<T> (*make)(), std::string& reason) {
  try {
    return make().release();
  } catch (const std::exception& error) {
    reason = error.what();
    return nullptr;
  }
}

}  // namespace

// Entry points of the shared object. Null with the reason if there is no OpenGL.
extern "C" void* dmise_make_renderer(std::string& reason) {
  return made(dmise::make_gl_renderer, reason);
}

extern "C" void* dmise_make_scene_renderer(std::string& reason) {
  return made(dmise::make_gl_scene_renderer, reason);
}
