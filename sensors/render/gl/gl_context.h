#pragma once
#include <memory>
#include <string>

namespace dmise {

/// A current OpenGL 4.5 core context with an off-screen framebuffer.
class GlContext {
 public:
  virtual ~GlContext() = default;
  virtual void make_current() = 0;
  virtual void* address(const char* function) = 0;
  virtual std::string name() const = 0;  // "OSMesa", "EGL"
};

/// Mesa's software rasteriser. Throws `Error` if libOSMesa is missing or has no OpenGL 4.5.
std::unique_ptr<GlContext> open_osmesa();

/// EGL without a surface, on a graphics card; null if there is none (software devices do not count)
/// or the build has no EGL.
std::unique_ptr<GlContext> open_egl(bool also_software = false);

/// Selected by `DMISE_RENDERER=osmesa|egl` in the environment; default EGL on a graphics card, else
/// OSMesa.
std::unique_ptr<GlContext> open_gl();

}  // namespace dmise
