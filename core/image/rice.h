#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

// RICE_1 of the FITS Standard 4.0, section 10.4.1 (Rice, Yeh & Miller 1993): differences of
// neighbours, folded to 0, -1, 1, -2, 2 ..., in blocks that each choose how many low bits stand as
// they are.
namespace dmise {

/// Unpacks one tile of 16-bit integers coded by RICE_1 with `block` pixels to a block. False when
/// the bytes end before the pixels do: unlike CFITSIO's decoder it never reads beyond them,
/// whatever they hold.
bool rice_decode(std::span<const std::uint8_t> bytes, std::size_t block,
                 std::span<std::int16_t> pixels);

}  // namespace dmise
