#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/image/fits_block.h"

namespace dmise {

enum class FitsPlace { primary, extension };

/// Writes a FITS image with uncompressed pixels: 16-bit unsigned (BZERO 32768), 8-bit, or 32-bit
/// floats, first row first; `cards` follow the structural ones. Written in pieces of 64 KB, so that
/// the image is not copied.
void put_image(const ByteSink& file, FitsPlace place, std::span<const std::uint16_t> pixels,
               int columns, std::span<const std::string> cards);
void put_image(const ByteSink& file, FitsPlace place, std::span<const std::uint8_t> pixels,
               int columns, std::span<const std::string> cards);
void put_image(const ByteSink& file, FitsPlace place, std::span<const float> pixels, int columns,
               std::span<const std::string> cards);

/// The cards that `put_image` writes of 16-bit pixels in the primary place, without END.
std::vector<std::string> count_image_cards(int columns, int rows,
                                           std::span<const std::string> cards);

}  // namespace dmise
