#pragma once
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>

// Structure of FITS files: blocks of 2880 bytes, cards of 80 characters (FITS Standard 4.0,
// sections 3.1 and 3.2).
namespace dmise {

constexpr std::size_t fits_block_bytes = 2880, fits_card_bytes = 80;

/// Receives the bytes of a file in pieces.
using ByteSink = std::function<void(std::string_view piece)>;

/// Padding that completes the last block after `bytes`.
inline std::string fits_padding(std::size_t bytes, char with) {
  return std::string((fits_block_bytes - bytes % fits_block_bytes) % fits_block_bytes, with);
}

/// A header of these cards, with END and padding.
inline std::string fits_header(std::span<const std::string> cards) {
  std::string header;
  for (const std::string& card : cards) header += card;
  header += "END";
  header.append(fits_card_bytes - 3, ' ');
  return header + fits_padding(header.size(), ' ');
}

}  // namespace dmise
