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

}  // namespace

std::unique_ptr<Renderer> load_renderer() {
  using Make = Renderer* (*)(std::string&);
  static const Make make = [] {
    const std::string path = module_path();
    void* const module = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!module) throw Error(std::string("renderer cannot be loaded: ") + ::dlerror());
    const auto entry = reinterpret_cast<Make>(::dlsym(module, "dmise_make_renderer"));
    if (!entry) throw Error(path + ": is no renderer");
    return entry;
  }();
  std::string reason;
  std::unique_ptr<Renderer> renderer(make(reason));
  if (!renderer) throw Error("renderer: " + reason);
  return renderer;
}

}  // namespace dmise
