#include <GL/osmesa.h>
#include <dlfcn.h>

#include <array>
#include <cstdlib>

#include "core/base/error.h"
#include "sensors/render/gl/gl_context.h"

namespace dmise {
namespace {

// The library is never unloaded: its threads and tables outlive a context.
void* osmesa_library() {
  static void* const library = [] {
    // The rasteriser uses the calling thread unless the variable is set.
    ::setenv("LP_NUM_THREADS", "0", 0);
    for (const char* name : {"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"})
      if (void* found = ::dlopen(name, RTLD_NOW | RTLD_LOCAL)) return found;
    return static_cast<void*>(nullptr);
  }();
  if (!library) throw Error("rendering needs libOSMesa (Debian: libosmesa6)");
  return library;
}

template <class F>
F function(const char* name) {
  const auto f = reinterpret_cast<F>(::dlsym(osmesa_library(), name));
  if (!f) throw Error(std::string("libOSMesa has no ") + name);
  return f;
}

class OsmesaContext final : public GlContext {
 public:
  OsmesaContext() {
    constexpr std::array<int, 13> wanted{OSMESA_FORMAT,
                                         OSMESA_RGBA,
                                         OSMESA_DEPTH_BITS,
                                         0,
                                         OSMESA_PROFILE,
                                         OSMESA_CORE_PROFILE,
                                         OSMESA_CONTEXT_MAJOR_VERSION,
                                         4,
                                         OSMESA_CONTEXT_MINOR_VERSION,
                                         5,
                                         0,
                                         0,
                                         0};
    context_ = function<decltype(&OSMesaCreateContextAttribs)>("OSMesaCreateContextAttribs")(
        wanted.data(), nullptr);
    if (!context_) throw Error("libOSMesa has no OpenGL 4.5 core");
    make_current();
  }
  ~OsmesaContext() override {
    function<decltype(&OSMesaDestroyContext)>("OSMesaDestroyContext")(context_);
  }
  void make_current() override {
    static const auto make = function<decltype(&OSMesaMakeCurrent)>("OSMesaMakeCurrent");
    if (!make(context_, surface_.data(), GL_UNSIGNED_BYTE, 1, 1))
      throw Error("OSMesa context cannot be made current");
  }
  void* address(const char* name) override {
    static const auto get = function<decltype(&OSMesaGetProcAddress)>("OSMesaGetProcAddress");
    return reinterpret_cast<void*>(get(name));
  }
  std::string name() const override { return "OSMesa"; }

 private:
  OSMesaContext context_ = nullptr;
  std::array<unsigned char, 4> surface_{};  // unused: drawing is into a framebuffer object
};

}  // namespace

std::unique_ptr<GlContext> open_osmesa() { return std::make_unique<OsmesaContext>(); }

}  // namespace dmise
