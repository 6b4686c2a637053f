#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

// Small strict readers of text fields, shared by the catalogue formats.
namespace dmise {

/// `text` without blanks, tabs and carriage returns at both ends.
std::string_view trimmed(std::string_view text);

/// The whole of `text` as a finite number; a leading '+' is allowed.
std::optional<double> parse_real(std::string_view text);

/// The whole of `text` as a decimal integer >= 0 that fits.
std::optional<std::uint32_t> parse_count(std::string_view text);

/// The whole of `text` as a decimal integer, either sign.
std::optional<int> parse_integer(std::string_view text);

/// `, got "text"`, with at most 80 characters of it and no control characters: for messages.
std::string got(std::string_view text);

/// `text` in upper case (ASCII).
std::string upper_case(std::string_view text);

/// Fields of one line of CSV (RFC 4180; a quoted field ends on its line).
std::vector<std::string> csv_fields(std::string_view line);

/// `text` without the UTF-8 byte order mark, if it begins with one.
std::string_view without_byte_order_mark(std::string_view text);

/// Cuts a text into lines; knows LF and CRLF and counts from 1.
class LineReader {
 public:
  explicit LineReader(std::string_view text) : rest_(text) {}
  /// The next line without its end, trailing blanks kept; nothing at the end of the text.
  std::optional<std::string_view> next();
  /// Number of the line that `next` gave last.
  int line() const { return line_; }

 private:
  std::string_view rest_;
  int line_ = 0;
};

}  // namespace dmise
