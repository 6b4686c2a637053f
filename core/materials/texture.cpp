#include "core/materials/texture.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"

namespace dmise {
namespace {

int wrapped(int i, int count, bool clamp) {
  if (clamp) return std::clamp(i, 0, count - 1);
  return (i % count + count) % count;
}

struct Between {
  int low, high;
  float share;  // weight of the higher texel
};

Between between(float place, int count, bool clamp) {
  const float whole = clamp ? std::clamp(place, 0.0f, 1.0f) : place - std::floor(place);
  const float at = whole * float(count) - 0.5f, low = std::floor(at);
  return {wrapped(int(low), count, clamp), wrapped(int(low) + 1, count, clamp), at - low};
}

}  // namespace

std::array<float, 3> Texture::at(const TexturePlace& place) const {
  const Between x = between(place.u, columns, clamp), y = between(place.v, rows, clamp);
  const auto texel = [&](int column, int row) {
    return texels.data() +
           (std::size_t(row) * std::size_t(columns) + std::size_t(column)) * std::size_t(channels);
  };
  const float *a = texel(x.low, y.low), *b = texel(x.high, y.low);
  const float *c = texel(x.low, y.high), *d = texel(x.high, y.high);
  std::array<float, 3> value{};
  for (int k = 0; k < std::min(3, channels); ++k) {
    const float above = a[k] + x.share * (b[k] - a[k]), below = c[k] + x.share * (d[k] - c[k]);
    value[std::size_t(k)] = above + y.share * (below - above);
  }
  return value;
}

Texture colour_texture(Texture described, LinearPicture picture) {
  if (described.base != 0.0 || described.gain != 1.0)
    for (float& v : picture.pixels)
      v = std::clamp(float(described.base + described.gain * double(v)), 0.0f, 1.0f);
  for (const float v : picture.pixels)
    if (!(v >= 0.0f && v <= 1.0f))
      throw Error("values must be from 0 to 1, got " + std::to_string(v));
  described.columns = picture.columns;
  described.rows = picture.rows;
  described.channels = 3;
  if (picture.channels == 3) {
    described.texels = std::move(picture.pixels);
  } else {
    described.texels.reserve(3 * picture.pixels.size());
    for (const float v : picture.pixels) described.texels.insert(described.texels.end(), 3, v);
  }
  return described;
}

Texture slope_texture(Texture described, const LinearPicture& picture) {
  const int columns = picture.columns, rows = picture.rows, channels = picture.channels;
  const auto height = [&](int x, int y) {
    const std::size_t pixel =
        std::size_t(wrapped(y, rows, described.clamp)) * std::size_t(columns) +
        std::size_t(wrapped(x, columns, described.clamp));
    float sum = 0.0f;
    for (int c = 0; c < channels; ++c)
      sum += picture.pixels[pixel * std::size_t(channels) + std::size_t(c)];
    return float(described.gain) * sum / float(channels);
  };
  described.columns = columns;
  described.rows = rows;
  described.channels = 2;
  described.texels.reserve(2 * std::size_t(columns) * std::size_t(rows));
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      described.texels.push_back(0.5f * float(columns) * (height(x + 1, y) - height(x - 1, y)));
      described.texels.push_back(0.5f * float(rows) * (height(x, y + 1) - height(x, y - 1)));
    }
  return described;
}

std::array<Vec<Body>, 2> place_gradients(const std::array<Vec<Body>, 3>& corner_m,
                                         const std::array<TexturePlace, 3>& place) {
  const Vec<Body> e1 = corner_m[1] - corner_m[0], e2 = corner_m[2] - corner_m[0];
  const Vec<Body> n = cross(e1, e2);
  const double square = dot(n, n);
  if (!(square > 0.0)) return {};
  const Vec<Body> a = cross(e2, n) / square, b = cross(n, e1) / square;
  return {a * double(place[1].u - place[0].u) + b * double(place[2].u - place[0].u),
          a * double(place[1].v - place[0].v) + b * double(place[2].v - place[0].v)};
}

}  // namespace dmise
