#include "sensors/render/render_module.h"

#include <dlfcn.h>

#include <cstdlib>
#include <filesystem>

#include "core/base/error.h"

namespace dmise {
namespace {

std::string module_path() {
  if (const char* path = std::getenv("DMISE_RENDER_MODULE")) return path;
  std::error_code failed;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", failed);
  return (program.parent_path().parent_path() / "lib" / "libdmise_render.so").string();
}

void* module() {
  static void* const loaded = [] {
    void* const found = ::dlopen(module_path().c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!found) throw Error(std::string("renderer cannot be loaded: ") + ::dlerror());
    return found;
  }();
  return loaded;
}

template <class T>
std::unique_ptr<T> made_by(const char* entry) {
  const auto make = reinterpret_cast<T* (*)(std::string&)>(::dlsym(module(), entry));
  if (!make) throw Error(module_path() + ": is no renderer");
  std::string reason;
  std::unique_ptr<T> renderer(make(reason));
  if (!renderer) throw Error("renderer: " + reason);
  return renderer;
}

}  // namespace

std::unique_ptr<Renderer> load_renderer() { return made_by<Renderer>("dmise_make_renderer"); }

std::unique_ptr<SceneRenderer> load_scene_renderer() {
  return made_by<SceneRenderer>("dmise_make_scene_renderer");
}

}  // namespace dmise
