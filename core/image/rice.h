#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

// RICE_1 of the FITS Standard 4.0, section 10.4.1 (Rice, Yeh & Miller 1993): differences of
// neighbours, folded to 0, -1, 1, -2, 2 ..., in blocks that each choose the number of low bits
// stored verbatim.
namespace dmise {

/// Decodes one tile of 16-bit integers compressed by RICE_1 with `block` pixels per block. Returns
/// false if the bytes end too early; unlike CFITSIO's decoder it never reads out of bounds.
bool rice_decode(std::span<const std::uint8_t> bytes, std::size_t block,
                 std::span<std::int16_t> pixels);

/// Whether the bytes hold a whole tile of `pixels` integers of 1, 2 or 4 bytes each.
bool rice_is_whole(std::span<const std::uint8_t> bytes, std::size_t block, int bytes_per_pixel,
                   std::size_t pixels);

}  // namespace dmise
