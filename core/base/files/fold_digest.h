#pragma once
#include <cstdint>

namespace dmise {

/// Mixes a value into a running 64-bit digest. Not cryptographic.
constexpr std::uint64_t fold_digest(std::uint64_t digest, std::uint64_t value) {
  digest = (digest ^ value) * 0x9e3779b97f4a7c15;  // 2^64 / golden ratio: spreads every bit upwards
  return digest ^ (digest >> 29);
}

}  // namespace dmise
