#pragma once
#include <array>

namespace dmise {

/// A rectangle of pixels (both ends in it) on which an image is a bicubic polynomial: at pixel
/// (x, y) the sum over i, j of coefficient[4 j + i] u^i v^j, u = u0 + du (x - x0), v likewise.
struct SkyPatch {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  float u0 = 0, du = 0, v0 = 0, dv = 0;
  std::array<float, 16> coefficient{};
};

}  // namespace dmise
