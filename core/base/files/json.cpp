#include "core/base/files/json.h"

#include <charconv>
#include <cmath>

#include "core/base/error.h"
#include "core/base/formatted.h"

namespace dmise {

void JsonWriter::separate() {
  if (need_comma_) text_ += ',';
  need_comma_ = true;
}

JsonWriter& JsonWriter::open(char bracket) {
  separate();
  text_ += bracket;
  need_comma_ = false;
  return *this;
}

JsonWriter& JsonWriter::close(char bracket) {
  text_ += bracket;
  need_comma_ = true;
  return *this;
}

JsonWriter& JsonWriter::key(std::string_view name) {
  value(name);
  text_ += ':';
  need_comma_ = false;
  last_key_ = name;
  return *this;
}

JsonWriter& JsonWriter::value(double number) {
  if (!std::isfinite(number)) throw Error("not a finite number: " + last_key_);
  char buffer[32];
  return raw({buffer, std::to_chars(buffer, buffer + sizeof buffer, number).ptr});
}

JsonWriter& JsonWriter::value(std::string_view text) {
  separate();
  text_ += '"';
  for (const char c : text) {
    if (c == '"' || c == '\\')
      (text_ += '\\') += c;
    else if (static_cast<unsigned char>(c) >= 0x20)
      text_ += c;
    else if (c == '\n')
      text_ += "\\n";
    else if (c == '\r')
      text_ += "\\r";
    else if (c == '\t')
      text_ += "\\t";
    else
      text_ += formatted("\\u%04x", static_cast<unsigned>(c));
  }
  text_ += '"';
  return *this;
}

JsonWriter& JsonWriter::raw(std::string_view text) {
  separate();
  text_ += text;
  return *this;
}

}  // namespace dmise
