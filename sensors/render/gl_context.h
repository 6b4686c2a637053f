#pragma once
#include <memory>
#include <string>

namespace dmise {

/// A current OpenGL 4.5 core context that draws into memory.
class GlContext {
 public:
  virtual ~GlContext() = default;
  virtual void make_current() = 0;
  virtual void* address(const char* function) = 0;
  virtual std::string name() const = 0;  // "OSMesa", "EGL"
};

/// Mesa's software rasteriser. Throws `Error` when libOSMesa is absent or has no OpenGL 4.5.
std::unique_ptr<GlContext> open_osmesa();

/// EGL without a surface, on a graphics card; nothing where there is none (a software device does
/// not count) or the build has no EGL.
std::unique_ptr<GlContext> open_egl(bool also_software = false);

/// `DMISE_RENDERER=osmesa|egl` in the environment, else EGL where a graphics card is, else OSMesa.
std::unique_ptr<GlContext> open_gl();

}  // namespace dmise
