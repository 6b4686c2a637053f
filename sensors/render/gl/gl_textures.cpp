#include "sensors/render/gl/gl_textures.h"

#include <algorithm>
#include <bit>

namespace dmise {

void GlTextures::bind(unsigned unit, const std::shared_ptr<const Texture>& texture,
                      float otherwise) {
  if (texture) {
    auto& sent = sent_[texture.get()];
    if (!sent.texture) sent = {texture, send(*texture)};
    gl_.BindTextureUnit(unit, sent.name);
    return;
  }
  if (plain_[unit] == 0) {
    Texture plain;
    plain.columns = plain.rows = 1;
    plain.channels = 3;
    plain.texels.assign(3, otherwise);
    plain_[unit] = send(plain);
  }
  gl_.BindTextureUnit(unit, plain_[unit]);
}

unsigned GlTextures::send(const Texture& texture) const {
  unsigned name = 0;
  gl_.CreateTextures(GL_TEXTURE_2D, 1, &name);
  const bool colours = texture.channels == 3;
  const int levels = std::bit_width(unsigned(std::max(texture.columns, texture.rows)));
  gl_.TextureStorage2D(name, levels, colours ? GL_RGBA16F : GL_RG32F, texture.columns,
                       texture.rows);
  gl_.TextureSubImage2D(name, 0, 0, 0, texture.columns, texture.rows, colours ? GL_RGB : GL_RG,
                        GL_FLOAT, texture.texels.data());
  gl_.GenerateTextureMipmap(name);
  const int wrap = texture.clamp ? GL_CLAMP_TO_EDGE : GL_REPEAT;
  gl_.TextureParameteri(name, GL_TEXTURE_WRAP_S, wrap);
  gl_.TextureParameteri(name, GL_TEXTURE_WRAP_T, wrap);
  gl_.TextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  gl_.TextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  return name;
}

}  // namespace dmise
