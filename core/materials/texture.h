#pragma once
#include <array>
#include <string>
#include <vector>

#include "core/base/image.h"
#include "core/orbit/attitude.h"
#include "core/pictures/picture_file.h"

namespace dmise {

/// Texture coordinates: u to the right, v up in a mesh file and down in a `Texture`; the picture
/// has width and height 1.
struct TexturePlace {
  float u = 0.0f, v = 0.0f;

  bool operator==(const TexturePlace&) const = default;
};

/// A picture mapped on a surface, with its options in the material file.
struct Texture {
  std::string file, where;              // name in the material file; file:line of it
  double scale_u = 1.0, scale_v = 1.0;  // repeats over a unit of u and v
  double offset_u = 0.0, offset_v = 0.0;
  double base = 0.0, gain = 1.0;  // a value becomes base + gain * value
  bool clamp = false;             // extend the edge outside; else repeat
  int columns = 0, rows = 0, channels = 0;
  std::vector<float> texels;  // rows x columns x channels, first row first

  TexturePlace of(const TexturePlace& in_mesh) const {
    return {float(offset_u + scale_u * in_mesh.u), float(1.0 - offset_v - scale_v * in_mesh.v)};
  }
  /// Bilinear between texel centres; missing channels are 0.
  std::array<float, 3> at(const TexturePlace& place) const;
};

/// Reflectance factors for red, green and blue. Throws `Error` for values outside [0, 1].
Texture colour_texture(Texture described, LinearPicture picture);

/// Slopes of a height map (mean of its channels) along u and along v (down), by central
/// differences.
Texture slope_texture(Texture described, const LinearPicture& picture);

/// Gradients of u and v over a triangle's plane [1/m], from the texture coordinates of its corners.
std::array<Vec<Body>, 2> place_gradients(const std::array<Vec<Body>, 3>& corner_m,
                                         const std::array<TexturePlace, 3>& place);

}  // namespace dmise
