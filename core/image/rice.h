#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

namespace dmise {

/// Unpacks one tile of 16-bit integers coded by RICE_1 with `block` pixels to a block: the FITS
/// Standard 4.0, section 10.4.1 (Rice, Yeh & Miller 1993). False when the bytes end before the
/// pixels do: unlike CFITSIO's decoder it never reads beyond them, whatever they hold.
bool rice_decode(std::span<const std::uint8_t> bytes, std::size_t block,
                 std::span<std::int16_t> pixels);

}  // namespace dmise
