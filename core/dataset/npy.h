#pragma once
#include <cstdint>
#include <span>
#include <string>

namespace dmise {

/// Content of a file of NumPy (NPY 1.0): rows x columns of unsigned 16-bit integers, little endian.
std::string npy_bytes(std::span<const std::uint16_t> pixels, int columns, int rows);

}  // namespace dmise
