#include "core/base/formatted.h"

#include <algorithm>
#include <charconv>
#include <cstdarg>
#include <cstdio>

namespace dmise {

std::string formatted(const char* format, ...) {
  std::va_list values, again;
  va_start(values, format);
  va_copy(again, values);
  std::string text(255, '\0');  // long enough for most
  const int length = std::max(0, std::vsnprintf(text.data(), text.size() + 1, format, values));
  const bool is_whole = std::size_t(length) <= text.size();
  text.resize(std::size_t(length));
  if (!is_whole) std::vsnprintf(text.data(), text.size() + 1, format, again);
  va_end(again);
  va_end(values);
  return text;
}

std::string counted(std::size_t number, const std::string& thing, const std::string& things) {
  const std::string several = things.empty() ? thing + "s" : things;
  return std::to_string(number) + " " + (number == 1 ? thing : several);
}

std::string shortest_text(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

}  // namespace dmise
