#pragma once
#include <string>
#include <string_view>

namespace dmise {

/// Returns `text` with a ? for each byte that is not printable ASCII: values of CCSDS messages have
/// no other characters.
inline std::string printable_ascii(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c < ' ' || c > '~') c = '?';
  return out;
}

}  // namespace dmise
