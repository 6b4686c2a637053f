#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "core/image/fits_memory.h"

namespace dmise {

/// Writes a FITS file of an empty primary HDU and images losslessly compressed by RICE_1, one tile
/// per row (FITS Standard 4.0, section 10), with CFITSIO, which writes each row as it is
/// compressed. Throws `Error` with the reason; an unclosed file is removed.
class TiledFile {
 public:
  explicit TiledFile(std::string path);
  ~TiledFile();

  /// Appends an image of 16-bit unsigned or 8-bit pixels; `cards` follow the structural ones.
  void add(std::span<const std::uint16_t> pixels, int columns, std::span<const std::string> cards);
  void add(std::span<const std::uint8_t> pixels, int columns, std::span<const std::string> cards);
  void close();

 private:
  void add(int image_type, int data_type, const void* pixels, std::size_t count, int columns,
           std::span<const std::string> cards);
  void require_ok();

  std::string path_;
  Fits fits_;
  bool closed_ = false;
};

}  // namespace dmise
