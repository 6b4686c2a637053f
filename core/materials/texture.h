#pragma once
#include <array>
#include <string>
#include <vector>

#include "core/base/image.h"
#include "core/orbit/attitude.h"
#include "core/pictures/picture_file.h"

namespace dmise {

/// A place on a picture: u to the right, v up in a file of a mesh and down in a `Texture`; the
/// picture is 1 wide and 1 high.
struct TexturePlace {
  float u = 0.0f, v = 0.0f;

  bool operator==(const TexturePlace&) const = default;
};

/// A picture laid on surfaces, and what the material file said of it.
struct Texture {
  std::string file, where;              // as it is named there; file:line
  double scale_u = 1.0, scale_v = 1.0;  // repeats over a unit of u and v
  double offset_u = 0.0, offset_v = 0.0;
  bool clamp = false;  // its edge goes on outside, else it repeats
  int columns = 0, rows = 0, channels = 0;
  std::vector<float> texels;  // rows x columns x channels, first row first

  TexturePlace of(const TexturePlace& in_mesh) const {
    return {float(offset_u + scale_u * in_mesh.u), float(1.0 - offset_v - scale_v * in_mesh.v)};
  }
  /// Bilinear between the middles of texels; channels that are not there are 0.
  std::array<float, 3> at(const TexturePlace& place) const;
};

/// Reflectance by red, green and blue as a factor. Throws `Error` for values outside [0, 1].
Texture colour_texture(Texture described, LinearPicture picture);

/// Slopes of a height map, the mean of its channels: along u and along v (down), by central
/// differences.
Texture slope_texture(Texture described, const LinearPicture& picture);

/// Gradients over a triangle's plane of the places on its corners: of u and of v [1/m].
std::array<Vec<Body>, 2> place_gradients(const std::array<Vec<Body>, 3>& corner_m,
                                         const std::array<TexturePlace, 3>& place);

}  // namespace dmise
