#pragma once
#include <string>

#include "core/base/formatted.h"

namespace dmise {

constexpr std::size_t longest_card_text = 64;  // limit of a sensor's name
constexpr int highest_sip_order = 9;           // by the convention

/// The shortest text that reads back to the same bits, with a decimal point or an exponent.
inline std::string number_text(double value) {
  std::string text = shortest_text(value);
  for (char& c : text)
    if (c == 'e') c = 'E';
  if (text.find_first_of(".E") == std::string::npos) text += ".0";
  return text;
}

}  // namespace dmise
