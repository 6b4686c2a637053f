#pragma once
#include <cstdint>

namespace dmise {

/// Joins a value into a running 64-bit digest. Tells runs apart; no defence against forgery.
constexpr std::uint64_t fold_digest(std::uint64_t digest, std::uint64_t value) {
  digest = (digest ^ value) * 0x9e3779b97f4a7c15;  // 2^64 / golden ratio: spreads every bit upwards
  return digest ^ (digest >> 29);
}

}  // namespace dmise
