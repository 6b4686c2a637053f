#pragma once
#include <cstddef>
#include <cstdint>

#include "core/base/numeric/simd_level.h"

namespace dmise {

/// CRC-32C (Castagnoli, reflected polynomial 0x82F63B78, as in RFC 3720). Pass the previous value
/// to continue over several pieces.
std::uint32_t crc32c(const void* data, std::size_t size, std::uint32_t previous = 0,
                     SimdLevel level = best_simd_level());

}  // namespace dmise
