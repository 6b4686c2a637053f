#include "core/products/observation.h"

namespace dmise {

std::string header_text(const std::string& text) {
  constexpr std::size_t longest = 60;
  std::string kept;
  std::size_t written = 0;
  for (const char c : text) {
    if ((static_cast<unsigned char>(c) & 0xC0) == 0x80) continue;  // the rest of a UTF-8 character
    written += c == '\'' ? 2 : 1;
    if (written > longest) break;
    kept += c >= 0x20 && c <= 0x7e ? c : '?';
  }
  // FITS ignores trailing blanks.
  kept.resize(kept.find_last_not_of(' ') + 1);
  return kept;
}

}  // namespace dmise
