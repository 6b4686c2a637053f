#include "core/materials/line_fields.h"

#include <charconv>
#include <cmath>

#include "core/base/error.h"

namespace dmise {
namespace {

constexpr std::string_view blanks = " \t\r\v\f";

/// Printable, shortened form of input text for messages.
std::string shown(std::string_view text) {
  std::string s;
  for (const char c : text.substr(0, 60)) s += c >= ' ' && c < 127 ? c : '?';
  return text.size() > 60 ? s + "..." : s;
}

}  // namespace

bool LineFields::next() {
  fields_.clear();
  bool continued = false;
  while (!text_.empty() && (fields_.empty() || continued)) {
    if (!continued) line_ = next_line_;
    const std::size_t end = text_.find('\n');
    std::string_view line = text_.substr(0, end);
    text_.remove_prefix(end == std::string_view::npos ? text_.size() : end + 1);
    ++next_line_;
    line = line.substr(0, line.find('#'));
    const std::size_t last = line.find_last_not_of(blanks);
    line = line.substr(0, last == std::string_view::npos ? 0 : last + 1);
    continued = !line.empty() && line.back() == '\\';
    if (continued) line.remove_suffix(1);
    for (std::size_t at = line.find_first_not_of(blanks); at != std::string_view::npos;) {
      const std::size_t stop = line.find_first_of(blanks, at);
      fields_.push_back(line.substr(at, stop == std::string_view::npos ? stop : stop - at));
      at = line.find_first_not_of(blanks, stop == std::string_view::npos ? line.size() : stop);
    }
  }
  return !fields_.empty();
}

std::string LineFields::rest() const {
  if (fields_.size() < 2) fail("needs a name");
  std::string name;
  for (std::size_t i = 1; i < fields_.size(); ++i)
    name += (i > 1 ? " " : "") + std::string(fields_[i]);
  return name;
}

double LineFields::number(std::size_t field) const {
  if (field >= fields_.size()) fail("needs " + std::to_string(field) + " numbers");
  std::string_view text = fields_[field];
  if (text.size() > 1 && text[0] == '+') text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc::result_out_of_range && end == text.data() + text.size()) {
    if (text.find("e-") == text.npos && text.find("E-") == text.npos)
      fail("number too large", fields_[field]);
    return 0.0;  // below the smallest double
  }
  if (error != std::errc{} || end != text.data() + text.size() || std::isnan(value))
    fail("must be a number", fields_[field]);
  if (std::abs(value) > 1e12) fail("number too large", fields_[field]);
  return value;
}

void LineFields::fail(const std::string& reason) const {
  throw ConfigError(where() + ": " + shown(keyword()) + ": " + reason);
}

void LineFields::fail(const std::string& reason, std::string_view got) const {
  fail(reason + ", got " + shown(got));
}

}  // namespace dmise
