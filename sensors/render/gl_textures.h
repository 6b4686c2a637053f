#pragma once
#include <map>
#include <memory>

#include "core/materials/texture.h"
#include "sensors/render/gl.h"

namespace dmise {

/// Pictures of materials as OpenGL has them, each sent once, with levels for every distance.
class GlTextures {
 public:
  explicit GlTextures(const Gl& gl) : gl_(gl) {}

  /// Null: one texel of 1 for colours, of 0 for slopes.
  void bind_colours(const std::shared_ptr<const Texture>& texture) { bind(0, texture, 1.0f); }
  void bind_slopes(const std::shared_ptr<const Texture>& texture) { bind(1, texture, 0.0f); }

 private:
  struct Sent {
    std::shared_ptr<const Texture> texture;  // kept, so that no other comes to its address
    unsigned name = 0;
  };
  void bind(unsigned unit, const std::shared_ptr<const Texture>& texture, float otherwise);
  unsigned send(const Texture& texture) const;

  const Gl& gl_;
  std::map<const Texture*, Sent> sent_;
  unsigned plain_[2] = {0, 0};
};

}  // namespace dmise
