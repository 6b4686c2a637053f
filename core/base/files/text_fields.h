#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

// Strict parsers of text fields, shared by the readers of catalogues and tables.
namespace dmise {

/// Returns `text` without leading and trailing blanks, tabs and carriage returns.
std::string_view trimmed(std::string_view text);

/// Parses the whole of `text` as a finite number; a leading '+' is allowed.
std::optional<double> parse_real(std::string_view text);

/// Parses the whole of `text` as a decimal integer >= 0 in range.
std::optional<std::uint32_t> parse_count(std::string_view text);

/// Parses the whole of `text` as a signed decimal integer in range.
std::optional<int> parse_integer(std::string_view text);

/// Returns `, got "text"` for messages, with at most 80 characters and no control characters.
std::string got(std::string_view text);

/// Returns `source:line: reason`, for messages.
std::string at_line(const std::string& source, int line, const std::string& reason);

/// `text` in upper case (ASCII).
std::string upper_case(std::string_view text);

/// Splits one line of CSV (RFC 4180; a quoted field ends on its line).
std::vector<std::string> csv_fields(std::string_view line);

/// Returns a text as a field of CSV, in quotes if it needs them (RFC 4180).
std::string csv_field(const std::string& text);

/// Returns a text that spreadsheets do not take for a formula: what begins as one gets an
/// apostrophe before it.
std::string formula_free(const std::string& text);

/// `text` without the UTF-8 byte order mark, if it begins with one.
std::string_view without_byte_order_mark(std::string_view text);

/// Splits a text into lines ended by LF or CRLF, counted from 1.
class LineReader {
 public:
  explicit LineReader(std::string_view text) : rest_(text) {}
  /// The next line without its end, trailing blanks kept; empty at the end of the text.
  std::optional<std::string_view> next();
  /// Number of the line last returned by `next`.
  int line() const { return line_; }

 private:
  std::string_view rest_;
  int line_ = 0;
};

}  // namespace dmise
