#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace dmise {

/// Reads a text of keyword lines (OBJ, MTL): fields separated by blanks, comments from # on, lines
/// continued by a backslash. Errors read `file:line: keyword: reason, got value`.
class LineFields {
 public:
  LineFields(std::string_view text, std::string file) : text_(text), file_(std::move(file)) {
    if (text_.starts_with("\xef\xbb\xbf")) text_.remove_prefix(3);  // byte order mark
  }

  /// Moves to the next line that has a field; false at the end.
  bool next();

  const std::string& file() const { return file_; }
  std::uint32_t line() const { return line_; }
  std::string where() const { return file_ + ":" + std::to_string(line_); }
  std::string_view keyword() const { return fields_[0]; }
  std::size_t size() const { return fields_.size(); }
  std::string_view operator[](std::size_t i) const { return fields_[i]; }
  /// Everything after the keyword, for names with blanks. Throws `ConfigError` if it is empty.
  std::string rest() const;

  /// A finite number of magnitude up to 1e12. Throws `ConfigError` otherwise.
  double number(std::size_t field) const;

  [[noreturn]] void fail(const std::string& reason) const;
  [[noreturn]] void fail(const std::string& reason, std::string_view got) const;

 private:
  std::string_view text_;
  std::string file_;
  std::vector<std::string_view> fields_;
  std::uint32_t line_ = 0;
  std::uint32_t next_line_ = 1;
};

}  // namespace dmise
