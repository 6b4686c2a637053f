#pragma once
#include <cstdint>
#include <span>
#include <string>

// FITS images compressed in tiles of one row, as the FITS Standard 4.0 has it in section 10.
// Written here, not by CFITSIO: in memory it moves all behind a table whenever the table grows, 50
// s for 8 million pixels.
namespace dmise {

/// The head of a FITS file without an image of its own.
std::string empty_primary();

/// Appends an image as a RICE_1 extension: 16-bit unsigned (BZERO 32768) or 8-bit pixels, first row
/// first, `cards` in its header. Throws `Error` for more than 2 GiB.
void append_rice_image(std::string& file, std::span<const std::uint16_t> pixels, int columns,
                       std::span<const std::string> cards);
void append_rice_image(std::string& file, std::span<const std::uint8_t> pixels, int columns,
                       std::span<const std::string> cards);

}  // namespace dmise
