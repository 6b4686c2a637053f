#include "sensors/render/gl/gl_context.h"

#ifdef DMISE_EGL
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <dlfcn.h>

#include <string_view>
#include <vector>

#include "sensors/render/gl/gl.h"

namespace dmise {
namespace {

/// Function pointers of libEGL.
struct Egl {
  PFNEGLGETPROCADDRESSPROC get = nullptr;

  template <class F>
  F function(const char* name) const {
    return reinterpret_cast<F>(get(name));
  }
};

class EglContext final : public GlContext {
 public:
  EglContext(const Egl& egl, EGLDisplay display, EGLContext context)
      : egl_(egl), display_(display), context_(context) {}
  ~EglContext() override {
    egl_.function<PFNEGLMAKECURRENTPROC>("eglMakeCurrent")(display_, EGL_NO_SURFACE, EGL_NO_SURFACE,
                                                           EGL_NO_CONTEXT);
    egl_.function<PFNEGLDESTROYCONTEXTPROC>("eglDestroyContext")(display_, context_);
  }
  bool try_current() {
    return egl_.function<PFNEGLMAKECURRENTPROC>("eglMakeCurrent")(display_, EGL_NO_SURFACE,
                                                                  EGL_NO_SURFACE, context_);
  }
  void make_current() override { try_current(); }
  void* address(const char* name) override { return reinterpret_cast<void*>(egl_.get(name)); }
  std::string name() const override { return "EGL"; }

 private:
  Egl egl_;
  EGLDisplay display_;
  EGLContext context_;
};

bool is_software(GlContext& context) {
  const auto get = reinterpret_cast<PFNGLGETSTRINGPROC>(context.address("glGetString"));
  const auto* text = get ? reinterpret_cast<const char*>(get(GL_RENDERER)) : nullptr;
  const std::string_view renderer = text ? text : "";
  for (const std::string_view soft : {"llvmpipe", "softpipe", "SWR", "swrast"})
    if (renderer.find(soft) != std::string_view::npos) return true;
  return renderer.empty();
}

std::unique_ptr<EglContext> context_on(const Egl& egl, EGLDisplay display) {
  if (display == EGL_NO_DISPLAY ||
      !egl.function<PFNEGLINITIALIZEPROC>("eglInitialize")(display, nullptr, nullptr) ||
      !egl.function<PFNEGLBINDAPIPROC>("eglBindAPI")(EGL_OPENGL_API))
    return nullptr;
  constexpr EGLint config_wanted[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, 0,
                                      EGL_NONE};
  EGLConfig config = nullptr;
  EGLint found = 0;
  egl.function<PFNEGLCHOOSECONFIGPROC>("eglChooseConfig")(display, config_wanted, &config, 1,
                                                          &found);
  constexpr EGLint wanted[] = {EGL_CONTEXT_MAJOR_VERSION,
                               4,
                               EGL_CONTEXT_MINOR_VERSION,
                               5,
                               EGL_CONTEXT_OPENGL_PROFILE_MASK,
                               EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                               EGL_NONE};
  const EGLContext context = egl.function<PFNEGLCREATECONTEXTPROC>("eglCreateContext")(
      display, found > 0 ? config : nullptr, EGL_NO_CONTEXT, wanted);
  if (context == EGL_NO_CONTEXT) return nullptr;
  auto held = std::make_unique<EglContext>(egl, display, context);
  return held->try_current() ? std::move(held) : nullptr;
}

}  // namespace

std::unique_ptr<GlContext> open_egl(bool also_software) {
  static void* const library = ::dlopen("libEGL.so.1", RTLD_NOW | RTLD_LOCAL);
  if (!library) return nullptr;
  const Egl egl{reinterpret_cast<PFNEGLGETPROCADDRESSPROC>(::dlsym(library, "eglGetProcAddress"))};
  if (!egl.get) return nullptr;
  const auto display_of = egl.function<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
  const auto devices = egl.function<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
  std::vector<EGLDisplay> displays;
  if (display_of && devices) {
    EGLDeviceEXT all[16];
    EGLint count = 0;
    if (devices(16, all, &count))
      for (EGLint i = 0; i < count; ++i)
        displays.push_back(display_of(EGL_PLATFORM_DEVICE_EXT, all[i], nullptr));
  }
  if (display_of)
    displays.push_back(display_of(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
  for (const EGLDisplay display : displays)
    if (auto context = context_on(egl, display))
      if (also_software || !is_software(*context)) return context;
  return nullptr;
}

}  // namespace dmise

#else

namespace dmise {

std::unique_ptr<GlContext> open_egl(bool) { return nullptr; }

}  // namespace dmise

#endif
