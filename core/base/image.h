#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace dmise {

/// Row-major image. (0, 0) is the centre of the first pixel, x along columns, y along rows (down).
/// `Carrier` makes images of different quantities different types.
template <class T, class Carrier>
struct Image {
  int columns = 0;
  int rows = 0;
  std::vector<T> pixels;  // rows x columns

  Image() = default;
  Image(int columns_, int rows_, T value = T{})
      : columns(columns_), rows(rows_), pixels(std::size_t(columns_) * std::size_t(rows_), value) {}

  T& at(int x, int y) { return pixels[std::size_t(y) * std::size_t(columns) + std::size_t(x)]; }
  const T& at(int x, int y) const {
    return pixels[std::size_t(y) * std::size_t(columns) + std::size_t(x)];
  }
  T* row(int y) { return pixels.data() + std::size_t(y) * std::size_t(columns); }
  const T* row(int y) const { return pixels.data() + std::size_t(y) * std::size_t(columns); }
};

/// Expected photo-electrons of one exposure, before any random draw [e-].
using ExpectedElectronImage = Image<float, struct ExpectedElectronCarrier>;
/// Electrons collected, after the random draws, before digitisation [e-].
using ElectronImage = Image<float, struct ElectronCarrier>;
/// Digitised counts, the output of the camera [DN].
using CountImage = Image<std::uint16_t, struct CountCarrier>;
/// 8-bit picture for display, one to three interleaved channels.
struct Picture {
  int columns = 0;
  int rows = 0;
  int channels = 3;
  std::vector<std::uint8_t> pixels;  // rows x columns x channels
};

}  // namespace dmise
