#pragma once
#include <map>
#include <memory>

#include "core/materials/texture.h"
#include "sensors/render/gl/gl.h"

namespace dmise {

/// Textures of materials in OpenGL with mipmaps, each uploaded once.
class GlTextures {
 public:
  explicit GlTextures(const Gl& gl) : gl_(gl) {}

  /// Null: a texel of 1 for colours, of 0 for slopes.
  void bind_colours(const std::shared_ptr<const Texture>& texture) { bind(0, texture, 1.0f); }
  void bind_slopes(const std::shared_ptr<const Texture>& texture) { bind(1, texture, 0.0f); }

 private:
  struct Sent {
    std::shared_ptr<const Texture> texture;  // keeps its address unique
    unsigned name = 0;
  };
  void bind(unsigned unit, const std::shared_ptr<const Texture>& texture, float otherwise);
  unsigned send(const Texture& texture) const;

  const Gl& gl_;
  std::map<const Texture*, Sent> sent_;
  unsigned plain_[2] = {0, 0};
};

}  // namespace dmise
